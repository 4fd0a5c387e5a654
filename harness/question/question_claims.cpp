#include "harness/question/question_claims.h"

#include <fmt/format.h>

#include <cmath>

#include "estimators/ready_made.h"
#include "harness/draws/sampler_setup.h"

namespace assay::harness {
namespace {

const ScaledQuantity* other_side(const Claim& claim) {
  return std::get_if<ScaledQuantity>(&claim.right);
}

/// The number on the right, without an error and not 0, so that a ratio to it can be tested.
Constant exact_number(const Claim& claim) {
  const Constant number = std::get<Constant>(claim.right);
  const char* name = to_string(claim.left.name);
  if (number.standard_error > 0) {
    throw InputError(
        claim.left.where,
        fmt::format("`{}` is tested against an exact number: `+-` has no method here", name));
  }
  if (number.value == 0) {
    throw InputError(claim.left.where,
                     fmt::format("`{}` is tested as a ratio: give a number above 0", name));
  }
  return number;
}

/// One source against a number, or two against each other.
Question one_or_two(const TestEntry& test, QuestionKind kind, const Estimators& estimators) {
  const Claim& claim = test.claim;
  Question question{
      .test = &test, .kind = kind, .subjects = {estimates(claim.left.source, estimators)}};
  if (const ScaledQuantity* other = other_side(claim)) {
    question.factor = other->factor;
    question.subjects.push_back(estimates(other->quantity.source, estimators));
  } else {
    question.references.assign(question.channel_count(), exact_number(claim));
  }
  return question;
}

/// The true mean of each channel: the number of `reference:`, else the plugin's.
std::vector<Constant> truths_of(const TestEntry& test, const Subject& subject,
                                const Source& source) {
  std::vector<Constant> truths;
  const std::vector<Channel> channels = subject.setup->channels();
  for (const std::size_t i : subject.channels) {
    if (!test.reference_number && !channels[i].mean) {
      throw InputError(
          source.where,
          fmt::format("the true mean of `{}` is not known to its plugin; give the test "
                      "a `reference:`, a number or an estimator",
                      to_string(source)));
    }
    truths.push_back(test.reference_number ? *test.reference_number
                                           : analytic_mean(channels[i], source));
  }
  return truths;
}

void add_reference(Question& question, const Estimators& estimators) {
  if (!question.test->reference) return;
  question.subjects.push_back(estimates(*question.test->reference, estimators));
  question.has_reference_subject = true;
}

bool is_biased(const Subject& subject) {
  return subject.estimator->nature().bias.value_or(BiasClass::unbiased) != BiasClass::unbiased;
}

/// Seconds are measured over blocks of drawing.
void require_drawn(const Question& question) {
  if (question.test->cost != CostKind::seconds) return;
  for (const Subject& subject : question.subjects) {
    if (subject.setup->observations()) {
      throw InputError(question.test->place_of("cost"),
                       fmt::format("`{}` is not drawn but read: its seconds say nothing",
                                   subject.estimator->name));
    }
    if (recorded::keeps_files(*subject.setup)) {
      throw InputError(question.test->place_of("cost"),
                       fmt::format("`{}` keeps what it made: the seconds of a file that is there "
                                   "say nothing; let `process` answer, or write the seconds as a "
                                   "number of the observation",
                                   subject.estimator->name));
    }
  }
}

/// The mean squared error of an averaging estimator depends on `primaries`, so the suite must say
/// it.
void require_primaries(const Subject& subject) {
  if (!subject.averages || subject.estimator->primaries) return;
  throw InputError(subject.estimator->where,
                   fmt::format("the mean squared error of `{}` depends on how many primaries it "
                               "averages: give it `primaries`",
                               subject.estimator->name));
}

Value with(const Value& parameters, const std::string& name, const Value& value) {
  std::vector<Value::Member> members;
  for (const Value::Member& member : parameters.members()) {
    if (member.first != name) members.push_back(member);
  }
  members.emplace_back(name, value);
  return Value::map(std::move(members), parameters.where());
}

/// The estimator at one value of the sweep.
PreparedEstimator swept(const PreparedEstimator& estimator, const std::string& parameter,
                        const Value& value) {
  PreparedEstimator point = estimator;
  if (parameter == "primaries") {
    point.primaries = value.count("a number of primaries");
  } else {
    point = prepare({.name = estimator.name,
                     .plugin = estimator.entry->information.name,
                     .parameters = with(estimator.given, parameter, value),
                     .primaries = estimator.primaries,
                     .where = value.where()},
                    estimator.folder);
  }
  point.name = fmt::format("{} ({} = {})", estimator.listed, parameter, value.text());
  return point;
}

void check_slope(const Claim& claim) {
  using enum QuantityName;
  const QuantityName name = claim.left.name;
  if (name == mean || name == bias || name == variance || name == cost) return;
  throw InputError(claim.left.where, fmt::format("`slope` takes a mean, bias, variance or cost, "
                                                 "not `{}`",
                                                 to_string(name)));
}

void require_counted(const TestEntry& test) {
  if (test.cost != CostKind::seconds) return;
  throw InputError(test.where, "a slope of seconds has no method; count `rays` or `samples`");
}

/// Variance and cost of an averaging estimator are those of one primary and do not depend on
/// `primaries`.
void require_slope_of_something(const TestEntry& test, const Subject& subject) {
  const QuantityName name = test.claim.left.name;
  const bool of_one = name == QuantityName::variance || name == QuantityName::cost;
  if (!of_one || !subject.averages || test.over->parameter != "primaries") return;
  throw InputError(test.claim.left.where,
                   fmt::format("`{}` is that of one primary of `{}`, which averages: it does not "
                               "change with `primaries`, and its slope is 0; sweep a parameter",
                               to_string(name), test.claim.left.source.estimator));
}

void require_whole_sampler(const Source& source, const Estimators& estimators) {
  const Subject marginal = draws(source, estimators, Draws::cells);
  const std::vector<Channel> channels = marginal.setup->channels();
  if (channels[marginal.channels[0]].name == cell_channel) return;
  throw InputError(source.where,
                   fmt::format("`integral` and `inconsistency` are about a whole sampler: name "
                               "`{}.{}`",
                               source.estimator, marginal.purpose));
}

}  // namespace

Question about_bias(const TestEntry& test, const Estimators& estimators) {
  const Claim& claim = test.claim;
  if (other_side(claim) != nullptr) {
    throw InputError(claim.left.where,
                     "a bias is compared with a number; to compare two estimators, claim their "
                     "means");
  }
  const Constant number = std::get<Constant>(claim.right);
  if (claim.relation == Relation::within && claim.margin.relative && number.value != 0) {
    throw InputError(claim.left.where,
                     "per cent of what? a margin on a bias other than 0 is a number");
  }
  Question question{.test = &test,
                    .kind = QuestionKind::mean_of_one,
                    .subjects = {estimates(claim.left.source, estimators)},
                    .offset = number.value};
  if (!test.reference) {
    question.references = truths_of(test, question.subjects[0], claim.left.source);
    for (Constant& truth : question.references) {
      truth.standard_error = std::hypot(truth.standard_error, number.standard_error);
    }
    return question;
  }
  if (number.standard_error > 0) {
    throw InputError(claim.left.where, "with a `reference` that is sampled, `+-` has no method");
  }
  question.kind = QuestionKind::mean_of_two;
  question.subjects.push_back(estimates(*test.reference, estimators));
  return question;
}

Question about_cost(const TestEntry& test, const Estimators& estimators) {
  Question question = one_or_two(test, QuestionKind::cost, estimators);
  require_drawn(question);
  return question;
}

Question about_efficiency(const TestEntry& test, const Estimators& estimators) {
  Question question = one_or_two(test, QuestionKind::efficiency, estimators);
  require_drawn(question);
  const bool asked = test.reference || test.reference_number;
  const std::vector<Source> sources = sources_of(test.claim);
  question.truths.resize(question.subjects.size());
  bool any = false;
  for (std::size_t i = 0; i < question.subjects.size(); ++i) {
    const Subject& subject = question.subjects[i];
    if (!asked && !is_biased(subject)) continue;
    require_primaries(subject);
    any = true;
    question.truths[i] = test.reference ? std::vector<Constant>(subject.channels.size())
                                        : truths_of(test, subject, sources[i]);
  }
  if (any && test.cost == CostKind::seconds) {
    throw InputError(test.where,
                     "a mean squared error per second has no method; count `rays` or `samples`");
  }
  add_reference(question, estimators);
  return question;
}

Question about_quantile(const TestEntry& test, const Estimators& estimators) {
  const Claim& claim = test.claim;
  Question question{.test = &test,
                    .kind = QuestionKind::quantile,
                    .subjects = {estimates(claim.left.source, estimators)}};
  const ScaledQuantity* other = other_side(claim);
  if (other == nullptr) {
    const Constant number = std::get<Constant>(claim.right);
    if (number.standard_error > 0) {
      throw InputError(claim.left.where,
                       "`quantile` is tested against an exact number: `+-` has no method here");
    }
    question.references.assign(question.channel_count(), number);
    return question;
  }
  if (other->quantity.arguments != claim.left.arguments) {
    throw InputError(other->quantity.where, "both quantiles must be of the same probability");
  }
  if (other->factor < 0) {
    throw InputError(other->quantity.where, "the factor of a quantile must be above 0");
  }
  question.factor = other->factor;
  question.subjects.push_back(estimates(other->quantity.source, estimators));
  return question;
}

Question about_total_variance(const TestEntry& test, const Estimators& estimators) {
  return one_or_two(test, QuestionKind::total_variance, estimators);
}

Question about_draws(const TestEntry& test, const Estimators& estimators) {
  const Claim& claim = test.claim;
  const bool integral = claim.left.name == QuantityName::integral;
  require_whole_sampler(claim.left.source, estimators);
  return {.test = &test,
          .kind = integral ? QuestionKind::integral : QuestionKind::inconsistency,
          .subjects = {draws(claim.left.source, estimators,
                             integral ? Draws::cells : Draws::consistency)},
          .references = {std::get<Constant>(claim.right)}};
}

Question about_slope(const TestEntry& test, const Estimators& estimators) {
  const Claim& claim = test.claim;
  check_slope(claim);
  require_counted(test);
  Question question{.test = &test, .kind = QuestionKind::slope, .subjects = {}};
  const PreparedEstimator& estimator = estimator_of(claim.left.source, estimators);
  for (const Value& value : test.over->values) {
    auto point =
        std::make_shared<const PreparedEstimator>(swept(estimator, test.over->parameter, value));
    Subject subject = estimates(claim.left.source, *point);
    if (claim.left.name == QuantityName::bias) {
      question.truths.push_back(test.reference ? std::vector<Constant>(subject.channels.size())
                                               : truths_of(test, subject, claim.left.source));
    }
    if (claim.left.name == QuantityName::cost) subject.channels.resize(1);
    subject.own = std::move(point);
    question.subjects.push_back(std::move(subject));
    question.sizes.push_back(value.number("a value of `over`"));
  }
  const Constant number = std::get<Constant>(claim.right);
  if (number.standard_error > 0) {
    throw InputError(claim.left.where,
                     "a slope is tested against an exact number: `+-` has no method here");
  }
  require_slope_of_something(test, question.subjects[0]);
  question.references.assign(question.channel_count(), number);
  add_reference(question, estimators);
  return question;
}

void check_worst_variance(const Claim& claim, const Estimators& estimators) {
  const Subject subject = estimates(claim.left.source, estimators);
  const bool bounded = claim.relation == Relation::at_most || claim.relation == Relation::less;
  const bool number = std::holds_alternative<Constant>(claim.right);
  if (subject.channels.size() == 1 || (bounded && number)) return;
  throw InputError(claim.left.where,
                   fmt::format("`worst_variance` of {} channels is bounded by a number from above "
                               "(`<=` or `<`): that every channel's variance is; there is no "
                               "method for another claim",
                               subject.channels.size()));
}

}  // namespace assay::harness
