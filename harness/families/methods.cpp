#include "harness/families/methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/draws/sampler_setup.h"
#include "harness/families/evidence_cells.h"
#include "harness/families/evidence_draws.h"
#include "harness/families/evidence_quantile.h"
#include "harness/families/evidence_ratio.h"
#include "harness/families/evidence_slope.h"
#include "harness/families/law_evidence.h"
#include "harness/families/mean_evidence.h"
#include "stats/variances/chi_square_variance.h"
#include "stats/variances/f_ratio.h"
#include "stats/variances/log_variance.h"

namespace assay::harness {
namespace {

using stats::Interval;
using stats::Moments;
using stats::TestResult;

Interval map_ends(const Interval& interval, const std::function<double(double)>& map) {
  const double one = map(interval.low);
  const double other = map(interval.high);
  return {std::min(one, other), std::max(one, other), interval.confidence};
}

/// theta = ln(Var x per primary / v0).
Evidence variance_against_number(const Method& method, const Question& question,
                                 std::size_t channel, const ChannelData& data) {
  const Moments x = data.moments;
  const double null =
      question.references[channel].value / question.subjects[0].averaged(data.primaries);
  const bool chi_square = method.name == "chi-square";
  const double excess = method.frozen.excess_kurtosis(channel).x;
  const auto at = [=](double theta) {
    const double variance = null * std::exp(theta);
    return chi_square ? stats::chi_square_variance(x, variance, excess)
                      : stats::log_variance(x, variance);
  };
  const auto interval = [=](double confidence) {
    if (!chi_square) return stats::log_variance_interval(x, null, confidence);
    return map_ends(stats::chi_square_variance_interval(x, confidence, excess),
                    [=](double variance) { return std::log(variance / null); });
  };
  return {.estimate = std::log(x.variance() / null),
          .at = at,
          .interval = interval,
          .quantity = "variance over the reference",
          .ratio = true};
}

/// theta = ln(Var x / (c Var y)), each per primary.
Evidence variance_against_variance(const Method& method, const Question& question,
                                   std::size_t channel, std::span<const ChannelData> data) {
  const Moments x = data[0].moments;
  const Moments y = data[1].moments;
  const double null = question.factor * question.subjects[1].averaged(data[1].primaries) /
                      question.subjects[0].averaged(data[0].primaries);
  const bool f = method.name == "F";
  const stats::ExcessKurtoses excess = method.frozen.excess_kurtosis(channel);
  const auto at = [=](double theta) {
    const double ratio = null * std::exp(theta);
    return f ? stats::f_ratio(x, y, ratio, excess) : stats::log_variance_ratio(x, y, ratio);
  };
  const auto interval = [=](double confidence) {
    if (f) {
      return map_ends(stats::f_ratio_interval(x, y, confidence, excess),
                      [=](double ratio) { return std::log(ratio / null); });
    }
    return map_ends(stats::log_variance_ratio_interval(x, y, confidence),
                    [=](double ln_ratio) { return ln_ratio - std::log(null); });
  };
  return {.estimate = std::log(x.variance() / y.variance() / null),
          .at = at,
          .interval = interval,
          .quantity = "ratio of variances",
          .ratio = true};
}

Evidence law_against_law(const Method& method, const Question& question, std::size_t channel,
                         std::span<const ChannelData> data) {
  const Points x = points_of(question, 0, channel, data[0].values);
  const Points y = points_of(question, 1, channel, data[1].values);
  const std::vector<std::optional<Atom>>& atoms = method.frozen.atoms;
  if (channel < atoms.size() && atoms[channel]) return points_split_at(atoms[channel]->value, x, y);
  return points_against_points(x, y);
}

Evidence values_against_law(const Method& method, const Question& question, std::size_t channel,
                            const ChannelData& data) {
  return points_against_law(points_of(question, 0, channel, data.values),
                            declared_law(question, channel),
                            method.name == "anderson-darling" ? PointsTest::anderson_darling
                                                              : PointsTest::kolmogorov_smirnov);
}

/// What the claim does not say itself: of what a bias or an error is taken, what is counted.
std::string circumstances(const Question& question) {
  const TestEntry& test = *question.test;
  std::string text;
  const QuantityName name = test.claim.left.name;
  if (test.reference) {
    text += fmt::format(", reference mean({})", to_string(*test.reference));
  } else if (name == QuantityName::bias && !question.of_two() && !question.references.empty() &&
             question.kind != QuestionKind::slope) {
    text += fmt::format(", reference {}", question.references[0].value);
  }
  if (name == QuantityName::cost || name == QuantityName::efficiency) {
    constexpr const char* kinds[] = {"rays", "samples", "seconds"};
    text += fmt::format(", cost in {}", kinds[static_cast<int>(test.cost)]);
  }
  if (test.over) text += fmt::format(" over {}", test.over->parameter);
  return text;
}

std::string side_text(const Question& question, std::size_t channel) {
  const Claim& claim = question.test->claim;
  if (const auto* other = std::get_if<ScaledQuantity>(&claim.right)) {
    return (other->factor == 1 ? "" : fmt::format("{} * ", other->factor)) +
           to_string(other->quantity);
  }
  if (question.test->claim.left.name == QuantityName::bias && !question.test->claim.left.slope) {
    return fmt::format("{}", question.offset);
  }
  if (question.kind == QuestionKind::image) {
    const auto* number = std::get_if<Constant>(&claim.right);
    return number != nullptr ? fmt::format("{}", number->value) : "analytic";
  }
  if (!question.references.empty()) return fmt::format("{}", question.references[channel].value);
  if (question.kind == QuestionKind::fit_to_density) return "its declared density";
  return to_string(question.law);
}

std::string relation_text(const TestEntry& test) {
  switch (test.claim.relation) {
    case Relation::equal:
      return "=";
    case Relation::less:
      return "<=";
    case Relation::greater:
      return ">=";
    case Relation::at_most:
    case Relation::at_least:
      return to_string(test.claim.relation);
    case Relation::within:
      break;
  }
  return fmt::format("within {} of", to_string(test.claim.margin));
}

/// Whether a side is a sampler's draws, whose mass without a point is a part of its own.
bool about_draws(const Question& question) {
  return std::any_of(question.subjects.begin(), question.subjects.end(),
                     [](const Subject& side) { return !side.purpose.empty(); });
}

[[noreturn]] void refuse(const Question& question, const std::string& method,
                         const std::string& why) {
  const Location& where = question.test->place_of("test");
  // An option says all of it.
  if (where.line == 0) throw InputError(where, why);
  throw InputError(where, fmt::format("`test: {}` {}", method, why));
}

/// Methods whose p-values are exact take the reference for exact, and the range for declared.
void require_exact_data(const Method& method, const Question& question) {
  const bool of_range = method.name == "bounded" || method.name == "betting";
  if (!of_range && method.name != "binomial") return;
  for (const Constant& reference : question.references) {
    if (reference.standard_error == 0) continue;
    refuse(question, method.name,
           "takes the reference for exact, but it has a standard error; leave `test` out");
  }
  for (const Subject& subject : question.subjects) {
    if (!of_range || !subject.setup->observations()) continue;
    refuse(question, method.name,
           fmt::format("needs a range that is declared, and the rows of `{}` declare none; leave "
                       "`test` out",
                       subject.estimator->name));
  }
}

/// A margin that the method cannot test.
void require_margins(const Method& method, const Question& question) {
  const TestEntry& test = *question.test;
  if (method.name != "anderson-darling" || !test.allow || test.allow->value == 0) return;
  throw InputError(test.place_of("allow"),
                   "`anderson-darling` tests that two laws are the same and knows no distance to "
                   "`allow` between them; leave `allow` out, or test by `ks`");
}

}  // namespace

stats::ExcessKurtoses Frozen::largest_excess_kurtosis() const {
  stats::ExcessKurtoses largest;
  for (const stats::ExcessKurtoses& each : excess_kurtoses) {
    largest = {.x = std::max(largest.x, each.x), .y = std::max(largest.y, each.y)};
  }
  return largest;
}

bool is_exact(const Method& method) {
  return method.name == "binomial" || method.name == "bounded" || method.name == "betting";
}

std::vector<Method> methods_for(const Question& question) {
  const bool within = question.test->claim.relation == Relation::within;
  switch (question.kind) {
    case QuestionKind::mean_of_one:
      if (within) {
        return {{"tost", Keeps::moments},
                {"skewness-corrected-t", Keeps::moments},
                {"binomial", Keeps::moments},
                {"bounded", Keeps::moments}};
      }
      return {{"t", Keeps::moments},          {"skewness-corrected-t", Keeps::moments},
              {"binomial", Keeps::moments},   {"bounded", Keeps::moments},
              {"batch-means", Keeps::values}, {"betting", Keeps::values}};
    case QuestionKind::mean_of_two:
      if (within) {
        return {{"tost", Keeps::moments},
                {"skewness-corrected-t", Keeps::moments},
                {"binomial", Keeps::moments}};
      }
      return {{"welch", Keeps::moments},
              {"skewness-corrected-t", Keeps::moments},
              {"binomial", Keeps::moments},
              {"batch-means", Keeps::values}};
    case QuestionKind::image:
      return {{"image", Keeps::images}};
    case QuestionKind::variance_of_one:
      return {{"chi-square", Keeps::moments}, {"log-variance", Keeps::moments}};
    case QuestionKind::variance_of_two:
      return {{"F", Keeps::moments}, {"log-variance", Keeps::moments}};
    case QuestionKind::fit_to_density: {
      const Subject& draws = question.subjects[0];
      const bool whole = draws.setup->channels()[draws.channels[0]].name == cell_channel;
      if (whole) return {{"chi-square-fit", Keeps::cells}};
      return {{"ks", Keeps::values}, {"anderson-darling", Keeps::values}};
    }
    case QuestionKind::fit_to_law:
      return {{"ks", Keeps::values}, {"anderson-darling", Keeps::values}};
    case QuestionKind::same_law:
    case QuestionKind::same_cells: {
      const Method cells{two_sample_cells, Keeps::points};
      if (question.kind == QuestionKind::same_cells) return {cells};
      if (about_draws(question)) return {{"ks", Keeps::values}, cells};
      return {{"ks", Keeps::values}, {"two-part-ks", Keeps::values}, cells};
    }
    case QuestionKind::cost:
    case QuestionKind::efficiency:
      if (question.test->cost == CostKind::seconds) return {{"replicates", Keeps::blocks}};
      if (question.kind == QuestionKind::cost) return {{"log-cost", Keeps::costs}};
      return {{"log-efficiency", Keeps::costs}};
    case QuestionKind::quantile:
      return {{question.of_two() ? "quantile" : "binomial", Keeps::values}};
    case QuestionKind::total_variance:
      return {{"log-total-variance", Keeps::group_variances}};
    case QuestionKind::integral:
    case QuestionKind::inconsistency:
      return {{"binomial", Keeps::cells}};
    case QuestionKind::slope:
      return {{"slope", question.test->claim.left.name == QuantityName::cost ? Keeps::costs
                                                                             : Keeps::moments}};
  }
  return {};
}

Method find_method(const Question& question, const std::string& name) {
  std::string known;
  for (const Method& method : methods_for(question)) {
    if (method.name == name) {
      require_exact_data(method, question);
      require_margins(method, question);
      return method;
    }
    known += (known.empty() ? "`" : ", `") + method.name + "`";
  }
  refuse(question, name, "does not answer this claim; there is " + known);
}

std::string null_hypothesis(const Method&, const Question& question, std::size_t channel) {
  const TestEntry& test = *question.test;
  std::string text = fmt::format("{} {} {}", to_string(test.claim.left), relation_text(test),
                                 side_text(question, channel));
  text += circumstances(question);
  if (question.kind == QuestionKind::image) text += " in every pixel";
  if (question.channel_count() > 1) {
    text += fmt::format(" in channel {}", question.channel_name(channel));
  }
  if (test.allow && test.allow->value > 0)
    text += fmt::format(", up to {}", to_string(*test.allow));
  return text;
}

Evidence evidence_of(const Method& method, const Question& question, std::size_t channel,
                     std::span<const ChannelData> data) {
  switch (question.kind) {
    case QuestionKind::mean_of_one:
      return mean_against_number(method, question, channel, data[0].moments, data[0].values);
    case QuestionKind::mean_of_two:
      return mean_against_mean(method, question, channel, data);
    case QuestionKind::variance_of_one:
      return variance_against_number(method, question, channel, data[0]);
    case QuestionKind::variance_of_two:
      return variance_against_variance(method, question, channel, data);
    case QuestionKind::fit_to_density:
      if (method.name == "chi-square-fit") return cells_against_density(question, data[0]);
      return values_against_law(method, question, channel, data[0]);
    case QuestionKind::fit_to_law:
      return values_against_law(method, question, channel, data[0]);
    case QuestionKind::same_law:
      return law_against_law(method, question, channel, data);
    case QuestionKind::same_cells:
      return cells_against_cells(method, question, data);
    case QuestionKind::cost:
    case QuestionKind::efficiency:
    case QuestionKind::total_variance:
      if (method.keeps == Keeps::blocks) return evidence_of_replicates(question, channel, data);
      return evidence_of_ratio(question, channel, data);
    case QuestionKind::quantile:
      return evidence_of_quantile(question, channel, data);
    case QuestionKind::integral:
      return evidence_of_integral(question, data[0]);
    case QuestionKind::inconsistency:
      return evidence_of_inconsistency(question, data[0]);
    case QuestionKind::image:
      break;  // image_evidence.h
    case QuestionKind::slope:
      return evidence_of_slope(question, channel, data);
  }
  throw std::logic_error("a question that one channel's data do not answer");
}

}  // namespace assay::harness
