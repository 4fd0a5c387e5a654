#include "harness/question/question.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "estimators/ready_made.h"
#include "harness/draws/sampler_setup.h"
#include "harness/language/method_names.h"
#include "harness/question/question_claims.h"
#include "harness/question/question_image.h"
#include "harness/sampling/recorded_run.h"

namespace assay::harness {
namespace {

std::vector<Constant> references(const Claim& claim, const Subject& subject) {
  std::vector<Constant> numbers;
  const std::vector<Channel> channels = subject.setup->channels();
  for (const std::size_t i : subject.channels) {
    if (const auto* constant = std::get_if<Constant>(&claim.right)) {
      if (claim.left.name != QuantityName::mean && constant->standard_error > 0) {
        throw InputError(claim.left.where,
                         "a variance is tested against an exact number: `+-` has no method here");
      }
      numbers.push_back(*constant);
    } else if (claim.left.name == QuantityName::variance) {
      numbers.push_back(analytic_variance(channels[i], claim.left.source));
    } else {
      numbers.push_back(analytic_mean(channels[i], claim.left.source));
    }
  }
  return numbers;
}

void require_pairs(const Question& question, const Claim& claim) {
  if (question.pooled()) return;
  const std::size_t first = question.subjects[0].channels.size();
  for (const Subject& other : question.subjects) {
    if (other.channels.size() == first) continue;
    throw InputError(claim.left.where,
                     fmt::format("the two sides have {} and {} channels; name one of each, as in "
                                 "`{}.channel`",
                                 first, other.channels.size(), claim.left.source.estimator));
  }
}

/// Columns of one file are dependent samples.
void require_different_data(const Question& question, const Claim& claim) {
  // Two estimators of one run have their own streams (`separate_pair`).
  if (as_recorded_run(*question.subjects[0].setup) != nullptr) return;
  const std::string first = question.subjects[0].setup->data_file();
  const auto same = [&](const Subject& other) { return other.setup->data_file() == first; };
  if (first.empty() ||
      std::count_if(question.subjects.begin(), question.subjects.end(), same) < 2) {
    return;
  }
  if (question.subjects[0].setup->image()) {
    throw InputError(claim.left.where,
                     fmt::format("both sides are the pictures `{}`; give one of them pictures of "
                                 "seeds of their own",
                                 first));
  }
  throw InputError(claim.left.where,
                   fmt::format("both sides are read from `{}`: its rows belong together and are no "
                               "independent samples; record the difference as a column of its own "
                               "and claim that its mean is 0",
                               first));
}

/// Gives the second of two sources with one key a stream of its own, if it is drawn.
bool separate_pair(Subject& first, Subject& second, const Claim& claim, std::uint64_t seed) {
  if (!(stream_of(first, seed) == stream_of(second, seed))) return false;
  if (first.setup->data_stream() && second.setup->data_stream()) {
    throw InputError(claim.left.where,
                     "both sides say that they were drawn from the same stream: they are not "
                     "independent; draw one of them with another `--seed`");
  }
  ++(second.setup->data_stream() ? first : second).copy;
  return true;
}

/// Sources with one key would draw the same numbers: all but one get streams of their own.
void separate_streams(Question& question, const Claim& claim, std::uint64_t seed) {
  std::vector<Subject>& subjects = question.subjects;
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      for (std::size_t j = i + 1; j < subjects.size(); ++j) {
        moved = separate_pair(subjects[i], subjects[j], claim, seed) || moved;
      }
    }
  }
}

std::string size_of(const Subject& subject) {
  if (subject.image) {
    return fmt::format("{} x {} pixels of {}", subject.image->width, subject.image->height,
                       fmt::join(subject.image->components, ", "));
  }
  return fmt::format("{} channels", subject.channels.size());
}

/// References from recorded means and their errors, channel by channel.
std::vector<Constant> recorded_means(const Question& question, const Subject& reference) {
  const Subject& subject = question.subjects[0];
  const bool one_size = subject.channels.size() == reference.channels.size() &&
                        (!subject.image || !reference.image ||
                         (subject.image->width == reference.image->width &&
                          subject.image->components.size() == reference.image->components.size()));
  if (!one_size) {
    throw InputError(
        question.test->claim.left.where,
        fmt::format("`{}` has {} and `{}` has {}: only what is of one size can be compared, "
                    "element by element",
                    subject.estimator->name, size_of(subject), reference.estimator->name,
                    size_of(reference)));
  }
  std::vector<Constant> means;
  const std::vector<Channel> channels = reference.setup->channels();
  for (const std::size_t i : reference.channels) {
    means.push_back({question.factor * channels[i].mean.value_or(0),
                     std::abs(question.factor) * channels[i].mean_error});
  }
  return means;
}

Question about_moments(const TestEntry& test, const Estimators& estimators) {
  const Claim& claim = test.claim;
  const bool mean = claim.left.name == QuantityName::mean;
  // The worst variance is bounded if every channel's is.
  if (claim.left.name == QuantityName::worst_variance) check_worst_variance(claim, estimators);
  Question question{.test = &test,
                    .kind = mean ? QuestionKind::mean_of_one : QuestionKind::variance_of_one,
                    .subjects = {estimates(claim.left.source, estimators)}};
  if (const auto* other = std::get_if<ScaledQuantity>(&claim.right)) {
    question.factor = other->factor;
    Subject second = estimates(other->quantity.source, estimators);
    if (mean && recorded::is_reference(*second.setup)) {
      question.references = recorded_means(question, second);
      question.factor = 1;
      return question;
    }
    question.kind = mean ? QuestionKind::mean_of_two : QuestionKind::variance_of_two;
    question.subjects.push_back(std::move(second));
  } else {
    question.references = references(claim, question.subjects[0]);
  }
  return question;
}

/// Cells need one or two coordinates, the same on both sides.
void require_plane(const Question& question) {
  const std::size_t first = question.subjects[0].channels.size();
  const std::size_t second = question.subjects[1].channels.size();
  if (first == second && first <= 2) return;
  throw InputError(question.test->place_of("test"),
                   fmt::format("`{}` counts in cells of one or two coordinates, the same of both "
                               "sides, which have {} and {}; name one channel of each",
                               *question.test->method, first, second));
}

/// The compared marginals, as "u, v".
std::string channel_names(const Subject& side) {
  const std::vector<Channel> channels = side.setup->channels();
  std::vector<std::string> names;
  for (const std::size_t channel : side.channels) names.push_back(channels[channel].name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Two samplers are compared marginal by marginal, so both need the same ones.
void require_same_marginals(const Question& question, const Location& where) {
  const Subject& first = question.subjects[0];
  const Subject& second = question.subjects[1];
  const auto is_whole = [](const Subject& side) {
    return dynamic_cast<const SamplerSetup*>(side.setup.get()) != nullptr &&
           side.channels.size() > 1;
  };
  if (!is_whole(first) || !is_whole(second)) return;
  const std::string names = channel_names(first);
  const std::string others = channel_names(second);
  if (names == others) return;
  throw InputError(where, fmt::format("the first sampler's points are {}, the second's {}: name "
                                      "one marginal of each to compare them all the same",
                                      names, others));
}

Question about_distribution(const TestEntry& test, const Estimators& estimators) {
  const Claim& claim = test.claim;
  const Source& source = claim.left.source;
  if (const auto* other = std::get_if<ScaledQuantity>(&claim.right)) {
    const bool cells = test.method && joins_channels(*test.method);
    Question question{
        .test = &test,
        .kind = cells ? QuestionKind::same_cells : QuestionKind::same_law,
        .subjects = {values(source, estimators), values(other->quantity.source, estimators)}};
    require_same_marginals(question, other->quantity.where);
    if (cells) require_plane(question);
    return question;
  }
  const Law& law = std::get<Law>(claim.right);
  if (law.name == "density") {
    return {.test = &test,
            .kind = QuestionKind::fit_to_density,
            .subjects = {draws(source, estimators, Draws::cells)}};
  }
  return {.test = &test,
          .kind = QuestionKind::fit_to_law,
          .subjects = {values(source, estimators)},
          .law = law};
}

void require_absolute(const Margin& margin, const char* reason) {
  if (!margin.relative) return;
  throw InputError(margin.where, fmt::format("a margin in per cent has no meaning here: {}; give "
                                             "an absolute number",
                                             reason));
}

const char* ratio_of(QuantityName name) {
  if (name == QuantityName::cost) return "costs";
  return name == QuantityName::efficiency ? "efficiencies" : "variances";
}

void check_margins(const Question& question) {
  const TestEntry& test = *question.test;
  for (const Margin& margin : margins_of(test)) {
    if (question.of_draws()) require_absolute(margin, "this is a probability");
    if (test.claim.left.name == QuantityName::distribution) {
      require_absolute(margin, "a distance between laws is a probability");
    }
    for (const Constant& reference : question.references) {
      if (question.kind == QuestionKind::slope || question.kind == QuestionKind::image) break;
      if (reference.value == 0) require_absolute(margin, "the reference is zero");
    }
    if (!margin.relative && question.on_log_scale() && question.of_two()) {
      throw InputError(margin.where,
                       fmt::format("a margin on a ratio of {} is relative; give it in per cent",
                                   ratio_of(test.claim.left.name)));
    }
    if (question.kind == QuestionKind::slope) {
      require_absolute(margin, "a slope is an exponent");
    }
    if (question.kind == QuestionKind::quantile && question.of_two()) {
      require_absolute(margin, "two quantiles differ by a number");
    }
  }
}

/// The largest reference known before drawing, also of a second mean. nullopt if there is none,
/// margins are not relative to it, or it is 0 within its error or rounding.
std::optional<double> known_size(const Question& question) {
  if (question.kind == QuestionKind::slope || question.of_draws()) return {};
  double largest = 0;
  const auto add = [&](double value, double error) {
    if (exceeds_its_error(value, error)) largest = std::max(largest, std::abs(value));
  };
  if (!question.references.empty()) {
    const std::vector<std::size_t>& first = question.subjects[0].channels;
    const std::vector<Channel> channels = question.subjects[0].setup->channels();
    for (std::size_t i = 0; i < question.references.size(); ++i) {
      const Constant& reference = question.references[i];
      const double rounding = channels[first[question.pooled() ? 0 : i]].rounding;
      add(reference.value, std::max(reference.standard_error, rounding));
    }
  }
  if (question.of_means() && question.of_two()) {
    const std::vector<Channel> others = question.subjects[1].setup->channels();
    for (const std::size_t channel : question.subjects[1].channels) {
      const Channel& other = others[channel];
      add(question.factor * other.mean.value_or(0), std::abs(question.factor) * other.rounding);
    }
  }
  return largest > 0 ? std::optional(largest) : std::nullopt;
}

void refuse_missing_per_cent(const Question& question) {
  const bool law = question.test->claim.left.name == QuantityName::distribution;
  const double size = known_size(question).value_or(0);
  for (const Margin& margin : margins_of(*question.test)) {
    if ((law || question.of_draws()) && margin.value > 1) {
      throw InputError(margin.where,
                       fmt::format("the margin {:g} is more than any difference of probabilities; "
                                   "here {:g} per cent is written `{:g}`",
                                   margin.value, margin.value, margin.value / 100));
    }
    const std::string per_cent = missing_per_cent(margin, size);
    if (!per_cent.empty()) throw InputError(margin.where, "the margin " + per_cent);
  }
}

void check_sizes(const Question& question) {
  const TestEntry& test = *question.test;
  const std::optional<std::uint64_t> most = question.most_rows();
  if (!most || test.secondaries.value_or(0) <= *most) return;
  const auto longest = std::ranges::find_if(question.subjects, [&](const Subject& subject) {
    return subject.setup->observations() == most;
  });
  throw InputError(test.place_of("secondaries"),
                   fmt::format("`secondaries: {}` is more than the {} observations that `{}` has",
                               *test.secondaries, *most, longest->estimator->name));
}

/// A mean with its error has no observations, so nothing else can be tested.
void require_observations(const Question& question) {
  for (const Subject& subject : question.subjects) {
    if (!recorded::is_reference(*subject.setup)) continue;
    throw InputError(question.test->claim.left.where,
                     fmt::format("`{0}` is a reference, a mean without observations: it can stand "
                                 "on the right of a mean, as in `mean(x) == mean({0})`",
                                 subject.estimator->name));
  }
}

Question asked(const TestEntry& test, const Estimators& estimators) {
  using enum QuantityName;
  if (test.claim.left.slope) return about_slope(test, estimators);
  switch (test.claim.left.name) {
    case mean:
    case variance:
    case worst_variance:
      return about_moments(test, estimators);
    case distribution:
      return about_distribution(test, estimators);
    case bias:
      return about_bias(test, estimators);
    case cost:
      return about_cost(test, estimators);
    case efficiency:
      return about_efficiency(test, estimators);
    case quantile:
      return about_quantile(test, estimators);
    case total_variance:
      return about_total_variance(test, estimators);
    case integral:
    case inconsistency:
      return about_draws(test, estimators);
  }
  throw std::logic_error("a claim about no quantity");
}

}  // namespace

bool Question::of_spread() const {
  return of_variances() || kind == QuestionKind::efficiency ||
         kind == QuestionKind::total_variance ||
         (kind == QuestionKind::slope && test->claim.left.name == QuantityName::variance);
}

std::optional<std::uint64_t> Question::most_rows() const {
  std::optional<std::uint64_t> most;
  for (const Subject& subject : subjects) most = std::max(most, subject.setup->observations());
  return most;
}

std::string Question::channel_name(std::size_t channel) const {
  if (kind == QuestionKind::cost) return "cost";
  if (kind == QuestionKind::same_cells) return "cells";
  if (kind == QuestionKind::image) return image_name(*subjects[0].image);
  if (kind == QuestionKind::total_variance && subjects[0].channels.size() > 1)
    return "all channels";
  return subjects[0].setup->channels()[subjects[0].channels[channel]].name;
}

Question ask(const TestEntry& test, const Estimators& estimators, std::uint64_t seed) {
  Question question = asked(test, estimators);
  require_observations(question);
  if (has_image(question)) ask_of_images(question);
  if (question.subjects.size() > 1) {
    require_pairs(question, test.claim);
    require_different_data(question, test.claim);
    separate_streams(question, test.claim, seed);
  }
  require_moments_suffice(question);
  check_margins(question);
  check_sizes(question);
  return question;
}

std::string written_key(const TestEntry& test, const std::string& key, const std::string& value) {
  const bool of_command_line = test.where.file == "claim";
  return of_command_line ? fmt::format("`--{} {}`", key, value)
                         : fmt::format("`{}: {}`", key, value);
}

std::vector<Margin> margins_of(const TestEntry& test) {
  std::vector<Margin> margins;
  if (test.detect) margins.push_back(*test.detect);
  if (test.allow) margins.push_back(*test.allow);
  if (test.claim.relation == Relation::within) margins.push_back(test.claim.margin);
  return margins;
}

std::string missing_per_cent(const Margin& margin, double size) {
  if (margin.relative || !(size > 0) || margin.value <= size) return "";
  return fmt::format(
      "{0:g} is larger than the reference, {1:.3g}: for {0:g} per cent write `{0:g}%`; if so much "
      "is "
      "meant, `{2:.0f}%`",
      margin.value, size, std::ceil(100 * margin.value / size));
}

Question ask_as_written(TestEntry& test, const Estimators& estimators, std::uint64_t seed) {
  const bool law = test.claim.left.name == QuantityName::distribution;
  if (law && !test.detect && !test.secondaries) {
    const std::vector<Source> sources = sources_of(test.claim);
    const bool given = std::ranges::any_of(sources, [&](const Source& source) {
      return estimator_of(source, estimators).setup->observations().has_value();
    });
    test.detect_by_default = !given;
  }
  if (test.detect_by_default) {
    test.detect = Margin{.value = default_law_effect};
    if (test.allow && test.allow->value >= default_law_effect) {
      throw InputError(test.allow->where,
                       fmt::format("`allow` ({}) is not below `detect`, which is {} by default; "
                                   "give a larger `detect`",
                                   to_string(*test.allow), default_law_effect));
    }
  }
  Question question = ask(test, estimators, seed);
  refuse_missing_per_cent(question);
  return question;
}

}  // namespace assay::harness
