#include "harness/theta/ask.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/sampling/prepare.h"
#include "harness/theta/theta.h"

namespace assay::harness {
namespace {

/// Columns of one file are dependent samples.
void require_different_data(const Question& question, const Claim& claim) {
  // Two estimators of one run have their own streams (`separate_streams`).
  if (as_recorded_run(*question.subjects[0].setup) != nullptr) return;
  const std::string first = question.subjects[0].setup->data_file();
  const auto same = [&](const Subject& other) { return other.setup->data_file() == first; };
  if (first.empty() || std::ranges::count_if(question.subjects, same) < 2) {
    return;
  }
  if (question.subjects[0].setup->image()) {
    refuse(claim.left.where,
           "both sides are the pictures `{}`; give one side pictures of other seeds", first);
  }
  refuse(claim.left.where,
         "both sides are read from `{}`: its rows belong together and are not independent samples; "
         "draw the rows of each side anew, in two files; for means, a column of differences also "
         "serves, whose mean is claimed to be 0",
         first);
}

/// Sources with one key would draw the same numbers: all but one get streams of their own. What was
/// drawn before keeps its stream.
void separate_streams(Question& question, const Claim& claim, std::uint64_t seed) {
  std::vector<StreamKey> taken;
  for (const bool is_drawn : {false, true}) {
    for (Subject& subject : question.subjects) {
      if (subject.setup->data_stream().has_value() == is_drawn) continue;
      while (std::ranges::count(taken, stream_of(subject, seed)) > 0) {
        if (!is_drawn) {
          refuse(claim.left.where,
                 "both sides were drawn from the same stream, so they are not independent; draw "
                 "one of them with another `--seed`");
        }
        ++subject.copy;
      }
      taken.push_back(stream_of(subject, seed));
    }
  }
}

/// InputError at the claim if it needs more of a recorded run than moments.
void require_moments_suffice(const Question& question) {
  for (std::size_t i = 0; i < question.subjects.size(); ++i) {
    const Subject& side = question.subjects[i];
    const RecordedRun* run = as_recorded_run(*side.setup);
    if (run == nullptr) continue;
    const std::string name = side.estimator->name;
    const bool reference = i >= question.compared();
    const Quantity& quantity = question.test->claim.left;
    const bool costs = quantity.row->counts_cost && !quantity.slope;
    if (!reference && !costs && !question.is().of_moments) {
      refuse(question.test->where,
             "`{}` has the moments of a run, not its observations: these suffice for mean, bias, "
             "variance, cost and efficiency, but not for this; write observations with `assay "
             "sample` and give them as `file`",
             name);
    }
    if (costs && !reference && !run->knows_cost(question.test->cost)) {
      refuse(question.test->where,
             "the run of `{}` did not record how its costs vary: add a claim about its efficiency "
             "to that run",
             name);
    }
    if (question.test->secondaries && *question.test->secondaries != run->summary.count) {
      refuse(question.test->place_of("secondaries"),
             "`{}` has the moments of {} observations together; leave `secondaries` out", name,
             run->summary.count);
    }
  }
}

std::vector<Margin> margins_of(const TestEntry& test) {
  std::vector<Margin> margins;
  if (test.detect) margins.push_back(*test.detect);
  if (test.allow) margins.push_back(*test.allow);
  if (test.claim.relation == Relation::within) margins.push_back(test.claim.margin);
  return margins;
}

void refuse_missing_per_cent(const Question& question) {
  const QuantityRow& quantity = *question.test->claim.left.row;
  const double size = question.theta->known_size(question, nullptr);
  for (const Margin& margin : margins_of(*question.test)) {
    if (quantity.is_a_probability() && margin.value >= 1) {
      refuse(margin.where,
             "a difference of probabilities is below 1, so it cannot be {:g}; write {:g} per cent "
             "as `{:g}`",
             margin.value, margin.value, margin.value / 100);
    }
    const std::string per_cent = missing_per_cent(margin, size);
    if (!per_cent.empty()) refuse(margin.where, "the margin " + per_cent);
  }
}

void check_sizes(const Question& question) {
  const TestEntry& test = *question.test;
  const std::optional<std::uint64_t> most = question.most_rows();
  if (!most || test.secondaries.value_or(0) <= *most) return;
  const auto longest = std::ranges::find_if(question.subjects, [&](const Subject& subject) {
    return subject.setup->observations() == most;
  });
  refuse(test.place_of("secondaries"),
         "`secondaries: {}` is more than the {} observations that `{}` has", *test.secondaries,
         *most, longest->estimator->name);
}

/// A mean with its error has no observations, so nothing else can be tested.
void require_observations(const Question& question) {
  for (const Subject& subject : question.subjects) {
    if (!subject.setup->is_reference()) continue;
    refuse(question.test->claim.left.where,
           "`{0}` is a reference, a mean without observations: it can only stand on the right of a "
           "mean, as in `mean(x) == mean({0})`",
           subject.estimator->name);
  }
}

/// Seconds are measured over blocks of drawing.
void require_drawn(const Question& question) {
  if (question.test->cost != CostKind::seconds) return;
  for (const Subject& subject : question.subjects) {
    if (!is_recorded(subject) && !subject.setup->keeps_files()) continue;
    refuse(question.test->place_of("cost"),
           "`{}` is read, maybe from an earlier run: its seconds mean nothing; draw it by "
           "`process`, or write the "
           "seconds as a number of the observation",
           subject.estimator->name);
  }
}

void ask_of_images(Question& question) {
  if (const Theta* const theta = question.theta->of_images()) {
    question.theta = theta;
    return;
  }
  const Subject& image =
      question.subjects[0].image ? question.subjects[0] : question.subjects.back();
  refuse(question.test->claim.left.where,
         "`{}` has no method for an image; there is mean, bias, total_variance and cost; or name "
         "one pixel, as in `{}.{}`",
         question.test->claim.left.row->word, image.estimator->name, element_name(*image.image, 0));
}

void ask_of_pairs(Question& question) {
  const Theta* const theta = question.theta->of_pairs(question);
  if (theta == nullptr) {
    refuse(question.test->place_of("paired"),
           "`paired` is only for the means of two images, as in `mean(new) == mean(old)`; leave it "
           "out");
  }
  question.theta = theta;
}

}  // namespace

bool has_image(const Question& question) {
  return std::ranges::any_of(question.subjects,
                             [](const Subject& subject) { return subject.image.has_value(); });
}

Question ask(const TestEntry& test, const Estimators& estimators, std::uint64_t seed) {
  const Quantity& left = test.claim.left;
  Question question = (left.slope ? left.row->slope : left.row->theta)->bind(test, estimators);
  require_observations(question);
  require_drawn(question);
  for (const Subject& other : question.subjects) {
    if (question.subjects[0].image && other.image) require_equal_pixels(question, other);
  }
  if (has_image(question)) ask_of_images(question);
  if (test.paired) ask_of_pairs(question);
  question.theta->check(question);
  if (question.subjects.size() > 1) {
    if (!question.is().joins_channels) require_one_size(question);
    require_different_data(question, test.claim);
    if (!question.is().of_pairs) separate_streams(question, test.claim, seed);
  }
  for (Subject& side : question.subjects) seed_cells(side, test.claim.left.where, seed);
  require_moments_suffice(question);
  for (const Margin& margin : margins_of(test)) question.theta->check_margin(question, margin);
  check_sizes(question);
  return question;
}

std::string written_key(const TestEntry& test, const std::string& key, const std::string& value) {
  const bool of_command_line = test.where.file == "claim";
  if (!of_command_line) return fmt::format("`{}: {}`", key, value);
  return value == "true" ? fmt::format("`--{}`", key) : fmt::format("`--{} {}`", key, value);
}

std::string missing_per_cent(const Margin& margin, double size) {
  if (margin.relative || !(size > 0) || margin.value <= size) return "";
  return fmt::format(
      "{0:g} is larger than the reference, {1:.3g}: for {0:g} per cent write `{0:g}%`; for so "
      "large a margin, `{2:.0f}%`",
      margin.value, size, std::ceil(100 * margin.value / size));
}

Question ask_as_written(TestEntry& test, const Estimators& estimators, std::uint64_t seed) {
  Question question = ask(test, estimators, seed);
  if (test.claim.left.row->of_a_law && !test.detect && !test.secondaries) {
    test.detect_by_default = !question.most_rows() && !has_image(question);
  }
  if (test.detect_by_default) {
    test.detect = Margin{.value = default_law_effect};
    if (test.allow && test.allow->value >= default_law_effect) {
      refuse(test.allow->where,
             "`allow` ({}) is not below `detect`, which is {} by default; give a larger `detect`",
             to_string(*test.allow), default_law_effect);
    }
  }
  refuse_missing_per_cent(question);
  question.written = margins_of(test);
  return question;
}

double unit_of_theta(const Question& question, std::size_t channel, double other_mean) {
  if (!question.theta->is_relative(question, channel)) return 1;
  return std::abs(question.of_two() ? question.factor * other_mean
                                    : question.references[channel].value);
}

double margin_on_theta(const Question& question, std::size_t channel, const Margin& margin) {
  if (!question.is().logarithm) return margin.value;
  if (margin.relative) return std::log1p(margin.value);
  return std::log1p(margin.value / question.references[channel].value);
}

bool has_margin(const TestEntry& test, bool in_per_cent) {
  return std::ranges::any_of(margins_of(test), [&](const Margin& margin) {
    return margin.relative == in_per_cent && margin.value > 0;
  });
}

}  // namespace assay::harness
