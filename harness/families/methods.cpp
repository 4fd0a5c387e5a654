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
#include "harness/language/method_names.h"
#include "harness/sampling/recorded_run.h"
#include "harness/theta/inversion.h"
#include "stats/variances/chi_square_variance.h"
#include "stats/variances/f_ratio.h"
#include "stats/variances/log_variance.h"

namespace assay::harness {
namespace {

using stats::Interval;
using stats::Moments;
using stats::TestResult;

/// theta = ln(Var x per primary / v0).
Evidence variance_against_number(bool chi_square, const Method& method, const Question& question,
                                 std::size_t channel, const ChannelData& data) {
  const Moments x = data.moments;
  const double null =
      question.references[channel].value / question.subjects[0].averaged(data.primaries);
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
Evidence variance_against_variance(bool f, const Method& method, const Question& question,
                                   std::size_t channel, std::span<const ChannelData> data) {
  const Moments x = data[0].moments;
  const Moments y = data[1].moments;
  const double null = question.factor * question.subjects[1].averaged(data[1].primaries) /
                      question.subjects[0].averaged(data[0].primaries);
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

/// Evidence about one or two variances, by the exact test of normal values or by logarithms.
template <bool exact>
Evidence of_variances(const Method& method, const Question& question, std::size_t channel,
                      std::span<const ChannelData> data) {
  if (question.of_two()) return variance_against_variance(exact, method, question, channel, data);
  return variance_against_number(exact, method, question, channel, data[0]);
}

template <PointsTest test>
Evidence values_against_law(const Method&, const Question& question, std::size_t channel,
                            std::span<const ChannelData> data) {
  return points_against_law(points_of(question, 0, channel, data[0].values),
                            declared_law(question, channel), test);
}

Evidence cells_of_density(const Method&, const Question& question, std::size_t,
                          std::span<const ChannelData> data) {
  return cells_against_density(question, data[0]);
}

Evidence cells_of_two(const Method& method, const Question& question, std::size_t,
                      std::span<const ChannelData> data) {
  return cells_against_cells(method, question, data);
}

Evidence ratio(const Method&, const Question& question, std::size_t channel,
               std::span<const ChannelData> data) {
  return evidence_of_ratio(question, channel, data);
}

Evidence ratio_of_replicates(const Method&, const Question& question, std::size_t channel,
                             std::span<const ChannelData> data) {
  return evidence_of_replicates(question, channel, data);
}

Evidence quantile(const Method&, const Question& question, std::size_t channel,
                  std::span<const ChannelData> data) {
  return evidence_of_quantile(question, channel, data);
}

Evidence integral(const Method&, const Question& question, std::size_t,
                  std::span<const ChannelData> data) {
  return evidence_of_integral(question, data[0]);
}

Evidence inconsistency(const Method&, const Question& question, std::size_t,
                       std::span<const ChannelData> data) {
  return evidence_of_inconsistency(question, data[0]);
}

Evidence slope(const Method&, const Question& question, std::size_t channel,
               std::span<const ChannelData> data) {
  return evidence_of_slope(question, channel, data);
}

Evidence whole_images(const Method&, const Question&, std::size_t, std::span<const ChannelData>) {
  throw std::logic_error("a claim on images has evidence of its own (image_evidence.h)");
}

/// Parts that the claim leaves unsaid: the reference of a bias or error, the kind of cost.
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

/// True if a side is a sampler's draws.
bool about_draws(const Question& question) {
  return std::any_of(question.subjects.begin(), question.subjects.end(),
                     [](const Subject& side) { return !side.purpose.empty(); });
}

[[noreturn]] void refuse(const Question& question, const std::string& method,
                         const std::string& why) {
  const Location& where = question.test->place_of("test");
  // The place of an option names the method itself.
  if (where.line == 0) throw InputError(where, why);
  throw InputError(where, fmt::format("`test: {}` {}", method, why));
}

/// Throws InputError if the data do not suit the method.
void require_data(const Method& method, const Question& question) {
  for (const Constant& reference : question.references) {
    if (!method.is.exact || reference.standard_error == 0) continue;
    refuse(question, method.name,
           "takes the reference for exact, but it has a standard error; leave `test` out");
  }
  for (const Subject& subject : question.subjects) {
    if (method.is.of_observations && as_recorded_run(*subject.setup) != nullptr) {
      refuse(question, method.name,
             fmt::format("needs observations, and `{}` has the moments of a run",
                         subject.estimator->name));
    }
    if (!method.is.in_range || !subject.setup->observations()) continue;
    refuse(question, method.name,
           fmt::format("needs a range that is declared, and the rows of `{}` declare none; leave "
                       "`test` out",
                       subject.estimator->name));
  }
}

/// Throws InputError if the method cannot test the claim's `allow`.
void require_margins(const Method& method, const Question& question) {
  const TestEntry& test = *question.test;
  if (method.is.allows_distance || !test.allow || test.allow->value == 0) return;
  throw InputError(test.place_of("allow"),
                   fmt::format("`{}` tests that two laws are the same and knows no distance to "
                               "`allow` between them; leave `allow` out, or test by `ks`",
                               method.name));
}

bool is_within(const Question& question) {
  return question.test->claim.relation == Relation::within;
}

bool in_seconds(const Question& question) { return question.test->cost == CostKind::seconds; }

/// True if a sampler's draws are tested against its density in cells of all coordinates.
bool of_whole_draws(const Question& question) {
  const Subject& draws = question.subjects[0];
  return question.kind == QuestionKind::fit_to_density &&
         draws.setup->channels()[draws.channels[0]].name == cell_channel;
}

bool of_one_law(const Question& question) {
  return question.kind == QuestionKind::fit_to_law ||
         (question.kind == QuestionKind::fit_to_density && !of_whole_draws(question));
}

template <QuestionKind kind>
bool is(const Question& question) {
  return question.kind == kind;
}

const std::vector<MethodRow> table{
    {"t",
     "Student's t: a mean against a number",
     [](const Question& q) { return q.kind == QuestionKind::mean_of_one && !is_within(q); },
     Keeps::moments,
     mean_by_t,
     {.scores = true}},
    {"welch",
     "Welch's t: two means, whatever their variances",
     [](const Question& q) { return q.kind == QuestionKind::mean_of_two && !is_within(q); },
     Keeps::moments,
     mean_by_t,
     {.scores = true}},
    {"tost",
     "two one-sided t tests: a mean lies within a margin",
     [](const Question& q) { return q.of_means() && is_within(q); },
     Keeps::moments,
     mean_by_t,
     {.scores = true}},
    {"skewness-corrected-t",
     "t or Welch with Hall's correction for the skewness of the values",
     [](const Question& q) { return q.of_means(); },
     Keeps::moments,
     mean_by_corrected_t,
     {.corrects_skewness = true}},
    {"binomial",
     "exact: a mean of values that are the two ends of a range",
     [](const Question& q) { return q.of_means(); },
     Keeps::moments,
     mean_of_two_values,
     {.exact = true, .of_observations = true, .plans = stats::ExactMethod::binomial}},
    {"bounded",
     "exact: a mean of values in a declared range",
     is<QuestionKind::mean_of_one>,
     Keeps::moments,
     mean_in_a_range,
     {.exact = true,
      .in_range = true,
      .of_observations = true,
      .plans = stats::ExactMethod::bounded}},
    {"batch-means",
     "t of batch means: a mean of observations that depend on their neighbours",
     [](const Question& q) { return q.of_means() && !is_within(q); },
     Keeps::values,
     mean_by_t,
     {.of_observations = true, .of_batches = true}},
    {"betting",
     "exact: a mean of values with a declared lower bound is not larger",
     [](const Question& q) { return q.kind == QuestionKind::mean_of_one && !is_within(q); },
     Keeps::values,
     mean_by_bets,
     {.exact = true, .in_range = true, .of_observations = true, .excludes_larger = false}},
    {"F",
     "F: two variances of near-normal values",
     is<QuestionKind::variance_of_two>,
     Keeps::moments,
     of_variances<true>,
     {.of_normal_values = true, .scores = true}},
    {"chi-square",
     "chi-square: a variance of near-normal values",
     is<QuestionKind::variance_of_one>,
     Keeps::moments,
     of_variances<true>,
     {.of_normal_values = true, .scores = true}},
    {"log-variance", "normal law of the logarithm of a variance: values of any shape",
     [](const Question& q) { return q.of_variances(); }, Keeps::moments, of_variances<false>},
    {"ks",
     "Kolmogorov-Smirnov: values against a law",
     of_one_law,
     Keeps::values,
     values_against_law<PointsTest::kolmogorov_smirnov>,
     {.of_distinct_values = true}},
    {"anderson-darling",
     "Anderson-Darling: values against a law, tails included",
     of_one_law,
     Keeps::values,
     values_against_law<PointsTest::anderson_darling>,
     {.of_distinct_values = true, .allows_distance = false, .power_is_known = false}},
    {"ks", "Kolmogorov-Smirnov: values of two", is<QuestionKind::same_law>, Keeps::values,
     law_against_law},
    {"two-part-ks",
     "Kolmogorov-Smirnov of two beside a value that comes again and again",
     [](const Question& q) { return q.kind == QuestionKind::same_law && !about_draws(q); },
     Keeps::values,
     law_against_law,
     {.power_is_known = false, .from_pilot = FromPilot::atoms}},
    {"chi-square-two-sample",
     "chi-square of two: one or two coordinates together, in cells",
     [](const Question& q) {
       return q.kind == QuestionKind::same_law || q.kind == QuestionKind::same_cells;
     },
     Keeps::points,
     cells_of_two,
     {.joins_channels = true, .from_pilot = FromPilot::cells}},
    {"chi-square-fit", "chi-square: draws against their declared density, in cells", of_whole_draws,
     Keeps::cells, cells_of_density},
    {"log-cost", "normal law of the logarithm of a cost",
     [](const Question& q) { return q.kind == QuestionKind::cost && !in_seconds(q); }, Keeps::costs,
     ratio},
    {"log-efficiency", "normal law of the logarithm of an efficiency",
     [](const Question& q) { return q.kind == QuestionKind::efficiency && !in_seconds(q); },
     Keeps::costs, ratio},
    {"replicates", "t of replicates: costs and efficiencies in seconds",
     [](const Question& q) {
       return (q.kind == QuestionKind::cost || q.kind == QuestionKind::efficiency) && in_seconds(q);
     },
     Keeps::blocks, ratio_of_replicates},
    {"log-total-variance", "normal law of the logarithm of the variances' sum",
     is<QuestionKind::total_variance>, Keeps::group_variances, ratio},
    {"binomial",
     "exact: a quantile against a number",
     [](const Question& q) { return q.kind == QuestionKind::quantile && !q.of_two(); },
     Keeps::values,
     quantile,
     {.exact = true}},
    {"quantile", "exact: two quantiles, by the counts on both sides",
     [](const Question& q) { return q.kind == QuestionKind::quantile && q.of_two(); },
     Keeps::values, quantile},
    {"binomial",
     "exact: what a sampler's density integrates to",
     is<QuestionKind::integral>,
     Keeps::cells,
     integral,
     {.exact = true}},
    {"binomial",
     "exact: how often a draw contradicts its sampler",
     is<QuestionKind::inconsistency>,
     Keeps::cells,
     inconsistency,
     {.exact = true}},
    {"slope", "weighted fit of a power law: costs over a parameter",
     [](const Question& q) {
       return q.kind == QuestionKind::slope && q.test->claim.left.name == QuantityName::cost;
     },
     Keeps::costs, slope},
    {"slope", "weighted fit of a power law: means, variances or biases over a parameter",
     [](const Question& q) {
       return q.kind == QuestionKind::slope && q.test->claim.left.name != QuantityName::cost;
     },
     Keeps::moments, slope},
    {"image",
     "cells of every size, alternating sums and the sum of squares: images",
     is<QuestionKind::image>,
     Keeps::images,
     whole_images,
     {.from_pilot = FromPilot::weights}}};

}  // namespace

stats::ExcessKurtoses Frozen::largest_excess_kurtosis() const {
  stats::ExcessKurtoses largest;
  for (const stats::ExcessKurtoses& each : excess_kurtoses) {
    largest = {.x = std::max(largest.x, each.x), .y = std::max(largest.y, each.y)};
  }
  return largest;
}

const std::vector<MethodRow>& method_table() { return table; }

const std::vector<std::string>& method_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> each;
    for (const MethodRow& row : table) {
      if (std::ranges::find(each, row.name) == each.end()) each.push_back(row.name);
    }
    return each;
  }();
  return names;
}

bool joins_channels(const std::string& method) {
  return std::ranges::any_of(
      table, [&](const MethodRow& row) { return row.name == method && row.is.joins_channels; });
}

std::vector<Method> methods_for(const Question& question) {
  std::vector<Method> methods;
  for (const MethodRow& row : table) {
    if (row.answers(question)) methods.push_back({row});
  }
  return methods;
}

Method find_method(const Question& question, const std::string& name) {
  std::string known;
  for (const Method& method : methods_for(question)) {
    if (method.name == name) {
      require_data(method, question);
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

}  // namespace assay::harness
