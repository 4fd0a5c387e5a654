#include "harness/question.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/sampler_setup.h"

namespace assay::harness {
namespace {

using Estimators = std::map<std::string, PreparedEstimator>;

const PreparedEstimator& estimator_of(const Source& source, const Estimators& estimators) {
  const auto found = estimators.find(source.estimator);
  if (found != estimators.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [name, unused] : estimators) names.push_back(name);
  const std::string near = nearest(source.estimator, names);
  throw InputError(source.where, fmt::format("no estimator `{}` in this suite{}", source.estimator,
                                             near.empty() ? "" : "; did you mean `" + near + "`?"));
}

std::string parts_of(const PreparedEstimator& estimator) {
  std::string text;
  const auto add = [&](const std::string& name) {
    text += (text.empty() ? "`" : ", `") + name + "`";
  };
  for (const Channel& channel : estimator.setup->channels()) add(channel.name);
  for (const NamedSampler& named : estimator.setup->samplers()) {
    add(named.name);
    for (const Marginal& marginal : marginals(named.sampler->domain())) {
      add(named.name + "." + marginal.name);
    }
  }
  return text;
}

[[noreturn]] void no_such_part(const Source& source, const PreparedEstimator& estimator) {
  throw InputError(source.where, fmt::format("`{}` has no part `{}`; it has {}", source.estimator,
                                             source.part, parts_of(estimator)));
}

std::vector<std::size_t> tested_channels(const std::vector<Channel>& channels) {
  std::vector<std::size_t> tested;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (!channels[i].diagnostic) tested.push_back(i);
  }
  return tested;
}

std::vector<std::size_t> channels_named(const std::vector<Channel>& channels,
                                        const std::string& name) {
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (channels[i].name == name) return {i};
  }
  return {};
}

/// The estimator's secondary estimates: all channels, or the one the part names.
Subject estimates(const Source& source, const Estimators& estimators) {
  const PreparedEstimator& estimator = estimator_of(source, estimators);
  const std::vector<Channel> channels = estimator.setup->channels();
  Subject subject{.estimator = &estimator,
                  .setup = estimator.setup,
                  .channels = source.part.empty() ? tested_channels(channels)
                                                  : channels_named(channels, source.part),
                  .averages = estimator.entry->information.averages};
  if (subject.channels.empty()) no_such_part(source, estimator);
  return subject;
}

/// The sampler a part names, itself or before a marginal's name; the only one when it names none.
const NamedSampler* sampler_named(const std::vector<NamedSampler>& samplers,
                                  const std::string& part, std::string& rest) {
  const auto dot = part.find('.');
  for (const NamedSampler& named : samplers) {
    if (named.name == part.substr(0, dot)) {
      rest = dot == std::string::npos ? "" : part.substr(dot + 1);
      return &named;
    }
  }
  rest = part;
  return samplers.size() == 1 ? &samplers[0] : nullptr;
}

/// A sampler's draws: cells of the whole domain, all marginals, or the marginal the part names.
enum class Draws { cells, marginals };

Subject draws(const Source& source, const Estimators& estimators, Draws what) {
  const PreparedEstimator& estimator = estimator_of(source, estimators);
  std::string rest;
  const std::vector<NamedSampler> samplers = estimator.setup->samplers();
  const NamedSampler* named = sampler_named(samplers, source.part, rest);
  if (named == nullptr) no_such_part(source, estimator);
  Subject subject{.estimator = &estimator,
                  .setup = sampler_setup(*named, source.where),
                  .purpose = named->name,
                  .channels = {},
                  .averages = false};
  const std::vector<Channel> channels = subject.setup->channels();
  if (!rest.empty()) {
    subject.channels = channels_named(channels, rest);
    if (rest == cell_channel) subject.channels.clear();
  } else if (what == Draws::cells) {
    subject.channels = channels_named(channels, cell_channel);
  } else {
    subject.channels = tested_channels(channels);
  }
  if (subject.channels.empty()) no_such_part(source, estimator);
  return subject;
}

/// A distribution's source: a channel where the part names one, else a sampler.
Subject values(const Source& source, const Estimators& estimators) {
  const PreparedEstimator& estimator = estimator_of(source, estimators);
  const std::vector<Channel> channels = estimator.setup->channels();
  if (source.part.empty() || !channels_named(channels, source.part).empty()) {
    return estimates(source, estimators);
  }
  return draws(source, estimators, Draws::marginals);
}

Constant analytic_mean(const Channel& channel, const Source& source) {
  if (channel.mean) return {*channel.mean, channel.mean_error};
  throw InputError(
      source.where,
      fmt::format("`{}` knows no analytic mean of `{}` with these parameters; give the "
                  "number, or compare with an estimator you trust",
                  source.estimator, channel.name));
}

Constant analytic_variance(const Channel& channel, const Source& source) {
  if (channel.variance) return {*channel.variance, 0};
  throw InputError(source.where,
                   fmt::format("`{}` knows no exact variance of `{}` with these parameters; give "
                               "the number",
                               source.estimator, channel.name));
}

std::vector<Constant> references(const Claim& claim, const Subject& subject) {
  std::vector<Constant> numbers;
  const std::vector<Channel> channels = subject.setup->channels();
  for (const std::size_t i : subject.channels) {
    if (const auto* constant = std::get_if<Constant>(&claim.right)) {
      if (claim.left.name == QuantityName::variance && constant->standard_error > 0) {
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
  const std::size_t first = question.subjects[0].channels.size();
  const std::size_t second = question.subjects[1].channels.size();
  if (first == second) return;
  throw InputError(claim.left.where,
                   fmt::format("the two sides have {} and {} channels; name one of each, as in "
                               "`{}.channel`",
                               first, second, claim.left.source.estimator));
}

/// Rows of one file belong together: two columns of it are no independent samples.
void require_different_data(const Question& question, const Claim& claim) {
  const std::string first = question.subjects[0].setup->data_file();
  if (first.empty() || first != question.subjects[1].setup->data_file()) return;
  throw InputError(claim.left.where,
                   fmt::format("both sides are read from `{}`: its rows belong together and are no "
                               "independent samples; record the difference as a column of its own "
                               "and claim that its mean is 0",
                               first));
}

/// The stream that a subject's observations are or were drawn from.
StreamKey stream_of(const Subject& subject, std::uint64_t seed) {
  return subject.setup->data_stream().value_or(
      key_of(*subject.estimator, seed, subject.copy, subject.purpose));
}

/// Sources of one key would draw the same numbers: one of them, the second if it is drawn at all,
/// gets a copy of its own.
void separate_streams(Question& question, const Claim& claim, std::uint64_t seed) {
  Subject& first = question.subjects[0];
  Subject& second = question.subjects[1];
  if (!(stream_of(first, seed) == stream_of(second, seed))) return;
  if (first.setup->data_stream() && second.setup->data_stream()) {
    throw InputError(claim.left.where,
                     "both files say that they were drawn from the same stream: they are not "
                     "independent; draw one of them with another `--seed`");
  }
  (second.setup->data_stream() ? first : second).copy = 1;
}

Question about_moments(const TestEntry& test, const Estimators& estimators) {
  const Claim& claim = test.claim;
  const bool mean = claim.left.name == QuantityName::mean;
  Question question{.test = &test,
                    .kind = mean ? QuestionKind::mean_of_one : QuestionKind::variance_of_one,
                    .subjects = {estimates(claim.left.source, estimators)}};
  if (const auto* other = std::get_if<ScaledQuantity>(&claim.right)) {
    question.kind = mean ? QuestionKind::mean_of_two : QuestionKind::variance_of_two;
    question.factor = other->factor;
    question.subjects.push_back(estimates(other->quantity.source, estimators));
  } else {
    question.references = references(claim, question.subjects[0]);
  }
  return question;
}

Question about_distribution(const TestEntry& test, const Estimators& estimators) {
  const Claim& claim = test.claim;
  const Source& source = claim.left.source;
  if (const auto* other = std::get_if<ScaledQuantity>(&claim.right)) {
    return {.test = &test,
            .kind = QuestionKind::same_law,
            .subjects = {values(source, estimators), values(other->quantity.source, estimators)}};
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

void require_absolute(const std::optional<Margin>& margin, const TestEntry& test,
                      const char* reason) {
  if (margin && margin->relative) {
    throw InputError(test.where, fmt::format("a margin in per cent has no meaning here: {}; give "
                                             "an absolute number",
                                             reason));
  }
}

void check_margins(const Question& question) {
  const TestEntry& test = *question.test;
  std::optional<Margin> within;
  if (test.claim.relation == Relation::within) within = test.claim.margin;
  if (test.detect && test.allow && test.allow->value > 0 &&
      test.detect->relative != test.allow->relative) {
    throw InputError(test.where, "`detect` and `allow` must both be in per cent or both absolute");
  }
  for (const auto& margin : {test.detect, test.allow, within}) {
    if (test.claim.left.name == QuantityName::distribution) {
      require_absolute(margin, test, "a distance between laws is a probability");
    }
    for (const Constant& reference : question.references) {
      if (reference.value == 0) require_absolute(margin, test, "the reference is zero");
    }
    if (margin && !margin->relative && question.kind == QuestionKind::variance_of_two) {
      throw InputError(test.where,
                       "a margin on a ratio of variances is relative; give it in per cent");
    }
  }
}

/// What the suite asks of a test that cannot be had from these sources.
void check_sizes(const Question& question) {
  const TestEntry& test = *question.test;
  for (const Subject& subject : question.subjects) {
    const auto rows = subject.setup->observations();
    if (rows && test.secondaries && *test.secondaries > *rows) {
      throw InputError(test.where, fmt::format("`secondaries: {}` is more than the {} observations "
                                               "that `{}` has",
                                               *test.secondaries, *rows, subject.estimator->name));
    }
  }
}

}  // namespace

std::string Question::channel_name(std::size_t channel) const {
  return subjects[0].setup->channels()[subjects[0].channels[channel]].name;
}

Question ask(const TestEntry& test, const Estimators& estimators, std::uint64_t seed) {
  const QuantityName name = test.claim.left.name;
  if (test.claim.left.slope || (name != QuantityName::mean && name != QuantityName::variance &&
                                name != QuantityName::distribution)) {
    throw InputError(test.claim.left.where,
                     fmt::format("this version tests `mean`, `variance` and `distribution`; it has "
                                 "no method for `{}`",
                                 test.claim.left.slope ? "slope" : to_string(name)));
  }
  Question question = name == QuantityName::distribution ? about_distribution(test, estimators)
                                                         : about_moments(test, estimators);
  if (question.of_two()) {
    require_pairs(question, test.claim);
    require_different_data(question, test.claim);
    separate_streams(question, test.claim, seed);
  }
  check_margins(question);
  check_sizes(question);
  return question;
}

}  // namespace assay::harness
