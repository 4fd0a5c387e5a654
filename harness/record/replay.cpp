#include "harness/record/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "estimators/catalogue.h"
#include "harness/base/interrupt.h"
#include "harness/base/record_file.h"
#include "harness/base/terminal.h"
#include "harness/draws/sampler_setup.h"
#include "harness/pilot/pilot.h"
#include "harness/plan/independence.h"
#include "harness/plan/pilot_shape.h"
#include "harness/record/record_of.h"
#include "harness/run/looks.h"
#include "harness/run/pools.h"
#include "harness/suite/suite.h"
#include "harness/suite/yaml.h"
#include "harness/theta/ask.h"
#include "harness/theta/methods.h"

namespace assay::harness {
namespace {

/// The nearest id to an unknown one; "" if none is near.
std::string meant(const std::string& asked, const std::vector<Recorded>& all) {
  std::vector<std::string> spellings;
  for (const Recorded& each : all) {
    spellings.push_back(each.test.id);
    spellings.push_back(each.test.name);
  }
  const std::string near = nearest(asked, spellings);
  for (const Recorded& each : all) {
    const bool is_near = !near.empty() && (each.test.id == near || each.test.name == near);
    if (is_near || (near.empty() && each.test.id.find(asked) != std::string::npos)) {
      return each.test.id;
    }
  }
  return "";
}

std::string some_ids(const std::vector<Recorded>& tests) {
  constexpr std::size_t most = 5;
  const auto id = [](const Recorded& each) { return each.test.id; };
  return quoted(names_of(std::span(tests).first(std::min(most, tests.size())), id)) +
         (tests.size() > most ? ", …" : "");
}

/// A list of texts without the colon before each.
Value unmarked(const Value& texts, const Location& where) {
  std::vector<Value> items;
  for (const Value& item : texts.items()) {
    items.push_back(Value::scalar(item.text().substr(1), where));
  }
  return Value::list(std::move(items), where);
}

/// Canonical parameters ("name=value,…") as in a suite. Text parameters have a colon before them.
/// Null and a scalar's fallback stand for parameters that were not given.
Value parameters_of(const reports::Sample& sample, const Location& where) {
  const std::vector<ParameterInformation>& declared =
      find_plugin(sample.plugin, where).information.parameters;
  std::vector<Value::Member> members;
  if (sample.parameters.empty()) return Value::map({}, where);
  for (const std::string& piece : split_outside_brackets(sample.parameters)) {
    const std::size_t equals = piece.find('=');
    const std::string name = piece.substr(0, equals);
    Value value = read_flow(piece.substr(equals + 1), where);
    const auto known = std::ranges::find(declared, name, &ParameterInformation::name);
    if (known == declared.end() || value.kind() == Value::Kind::null) continue;
    if (known->type == ParameterType::string) value = Value::scalar(value.text().substr(1), where);
    const bool is_scalar = value.kind() == Value::Kind::scalar;
    if (is_scalar && !known->fallback.empty() && value.text() == known->fallback) continue;
    if (known->type == ParameterType::texts) value = unmarked(value, where);
    members.emplace_back(name, std::move(value));
  }
  return Value::map(std::move(members), where);
}

void read_keys(const reports::Test& recorded, TestEntry& test) {
  const Location where{.file = recorded.file};
  std::vector<Value::Member> keys;
  if (!recorded.over.empty()) keys.emplace_back("over", read_flow(recorded.over, where));
  if (!recorded.reference.empty()) {
    keys.emplace_back("reference", Value::scalar(recorded.reference, where));
  }
  if (!recorded.cost.empty()) keys.emplace_back("cost", Value::scalar(recorded.cost, where));
  if (recorded.paired) keys.emplace_back("paired", Value::scalar("true", where));
  read_test_keys({}, Value::map(std::move(keys), where), test);
}

bool has_relative_effect(const Claim& claim) {
  if (claim.left.slope) return false;
  return claim.left.row->relative_effect;
}

/// The folder of the suite's file, relative to here or else to the record. It is absolute, so that
/// errors say where a file was expected.
std::string folder_of(const std::string& suite, const std::string& record) {
  namespace fs = std::filesystem;
  if (suite.empty()) return fs::current_path().string();  // a claim of the command line
  const fs::path beside = fs::absolute(record).parent_path() / suite;
  const fs::path file = fs::exists(suite) || !fs::exists(beside) ? fs::absolute(suite) : beside;
  return file.parent_path().string();
}

/// The suite of this one test, from the record alone.
Suite suite_of(const Recorded& recorded, const std::string& record) {
  Suite suite{.name = recorded.suite.name,
              .file = recorded.suite.file,
              .folder = folder_of(recorded.suite.file, record),
              .alpha = recorded.suite.alpha,
              .beta = recorded.suite.beta};
  for (const reports::Sample& sample : recorded.test.samples) {
    const auto known = std::ranges::find(suite.estimators, sample.estimator, &EstimatorEntry::name);
    if (known != suite.estimators.end()) continue;
    const Location where{.file = recorded.suite.file};
    suite.estimators.push_back({.name = sample.estimator,
                                .plugin = sample.plugin,
                                .parameters = parameters_of(sample, where),
                                .primaries = sample.primaries,
                                .where = where});
  }
  TestEntry test{.name = recorded.test.name,
                 .id = recorded.test.id,
                 .claim = parse_claim(recorded.test.claim, {.file = recorded.suite.file}),
                 .method = recorded.test.method};
  read_keys(recorded.test, test);
  // Recorded margins are on theta's scale. Here they only tell whether means are compared in units
  // of the reference; the plan has the numbers.
  if (has_relative_effect(test.claim) && test.claim.relation != Relation::within) {
    const bool relative =
        !recorded.test.channels.empty() && recorded.test.channels[0].effect.relative;
    if (recorded.test.detect) test.detect = Margin{*recorded.test.detect, relative};
    if (recorded.test.allow) test.allow = Margin{*recorded.test.allow, relative};
  }
  test.where.file = recorded.suite.file;
  suite.tests.push_back(std::move(test));
  return suite;
}

std::uint64_t most_recorded(const reports::Test& test) {
  return std::ranges::max(test.samples, {}, &reports::Sample::secondaries).secondaries;
}

/// The record's sample of a subject's channel, or null.
const reports::Sample* recorded_of(const reports::Test& test, const Question& question,
                                   std::size_t subject, std::size_t channel) {
  const Subject& side = question.subjects[subject];
  const auto channels = side.channels.all();
  if (std::ranges::find(channels, channel) == channels.end()) return nullptr;
  // Samples of two subjects with one estimator are in the subjects' order.
  auto earlier = std::ranges::count_if(
      std::span(question.subjects).first(subject),
      [&](const Subject& each) { return each.estimator->listed == side.estimator->listed; });
  const std::string name = side.setup->channels()[channel].name;
  for (const reports::Sample& sample : test.samples) {
    const bool is_its = sample.estimator == side.estimator->listed &&
                        (side.image.has_value() || sample.channel == name);
    if (is_its && earlier-- == 0) return &sample;
  }
  return nullptr;
}

/// The looks that were planned; what was drawn of constants.
stats::LookSchedule recorded_looks(const Question& question, const Recorded& recorded,
                                   stats::LookLaw law) {
  const reports::Test& test = recorded.test;
  const stats::ErrorRates errors{.alpha = test.alpha.value_or(recorded.suite.alpha),
                                 .beta = test.beta.value_or(recorded.suite.beta),
                                 .two_sided = is_two_sided(question.test->claim.relation)};
  if (test.looks.empty()) return stats::schedule_looks({most_recorded(test)}, law, errors);
  return stats::schedule_looks(test.planned_looks, law, errors);
}

/// The recorded plan, so that no pilot is needed.
Plan recorded_plan(const Question& question, const Recorded& recorded) {
  const reports::Test& test = recorded.test;
  const Method method = find_method(question, test.method);
  Plan plan{.method = method,
            .looks = recorded_looks(question, recorded, method.is.over_looks),
            .gates_invalidate = !test.forced};
  for (std::size_t i = 0; i < question.subjects.size(); ++i) {
    const Subject& side = question.subjects[i];
    const reports::Sample* const sample = recorded_of(test, question, i, side.channels[0]);
    plan.primaries.push_back(sample != nullptr ? sample->primaries
                                               : side.estimator->primaries.value_or(1));
  }
  plan.regions.assign(question.channel_count(), {.relation = question.test->claim.relation,
                                                 .allow = test.allow.value_or(0),
                                                 .detect = test.detect});
  return plan;
}

/// The test ready to be drawn, with everything it refers to.
struct Rebuilt {
  Suite suite;
  std::map<std::string, PreparedEstimator> estimators;
  Pools pools;
  TestWork work;
};

/// The run's pilots, which depend on seed and estimators alone. Larger ones only choose methods and
/// sizes, so they are not drawn.
Pilots pilots_of(const Rebuilt& rebuilt, const Question& question, std::uint64_t seed) {
  std::vector<const PreparedEstimator*> all;
  for (const auto& [name, estimator] : rebuilt.estimators) all.push_back(&estimator);
  const std::unique_ptr<Progress> progress = make_progress(false);
  Pilots pilots = run_pilots(all, {.seed = seed, .draws = piloted_draws(question)}, *progress);
  stop_if_interrupted();
  if (const std::string why = where_pilots_stopped(question, pilots); !why.empty()) {
    throw std::runtime_error(why);
  }
  return pilots;
}

/// InputError if recorded data changed since.
void require_same_rows(const Question& question, const Recorded& recorded,
                       const std::string& record) {
  for (std::size_t i = 0; i < question.subjects.size(); ++i) {
    const Subject& side = question.subjects[i];
    const reports::Sample* then = recorded_of(recorded.test, question, i, side.channels[0]);
    const auto now = side.setup->observations();
    // A recorded run is taken whole.
    if (!now || !then || then->secondaries == *now) continue;
    if (then->secondaries == side.secondaries(most_recorded(recorded.test))) continue;
    refuse({.file = record},
           "the test took {} observations of `{}`, of which there are now {}: replay needs the "
           "data as they were",
           then->secondaries, side.estimator->name, *now);
  }
}

/// Another test of the suite may have paired an estimator, so the record alone knows its numbers.
void draw_recorded_streams(Question& question, const reports::Test& test) {
  for (std::size_t i = 0; i < question.subjects.size(); ++i) {
    Subject& side = question.subjects[i];
    const reports::Sample* const sample = recorded_of(test, question, i, side.channels[0]);
    if (sample != nullptr) side.stream = read_stream(sample->stream);
  }
}

std::unique_ptr<Rebuilt> rebuild(const Recorded& recorded, const std::string& record) {
  auto rebuilt = std::make_unique<Rebuilt>();
  rebuilt->suite = suite_of(recorded, record);
  require_lasting_rows(rebuilt->suite, record);
  rebuilt->estimators = prepare_all(rebuilt->suite);
  TestWork& work = rebuilt->work;
  TestOutcome& outcome = work.outcome;
  outcome.question = ask(rebuilt->suite.tests[0], rebuilt->estimators, recorded.suite.seed);
  outcome.plan = recorded_plan(outcome.question, recorded);
  outcome.place = {.inside = false,
                   .share = {.alpha = recorded.test.alpha.value_or(rebuilt->suite.alpha),
                             .beta = recorded.test.beta.value_or(rebuilt->suite.beta)}};
  require_same_rows(outcome.question, recorded, record);
  draw_recorded_streams(outcome.question, recorded.test);
  if (outcome.plan.method.is.cells_of_pilots) {
    freeze(outcome, pilots_of(*rebuilt, outcome.question, recorded.suite.seed));
  }
  if (!recorded.test.looks.empty()) work.last_look = recorded.test.looks.size() - 1;
  work.pools = rebuilt->pools.for_question(outcome.question, outcome.plan, recorded.suite.seed, {});
  return rebuilt;
}

/// Says whether the value is possible: it is in the recorded range, or some recorded values are not
/// finite.
bool print_against(const reports::Sample& sample, double value) {
  if (!std::isfinite(value)) {
    const bool same = sample.nonfinite > 0;
    fmt::print("  {}\n",
               same ? fmt::format("not finite, as {} of the {} recorded", sample.nonfinite,
                                  sample.secondaries)
                    : fmt::format("NOT as recorded: all {} were finite", sample.secondaries));
    return same;
  }
  if (!sample.min || !sample.max) return true;
  const bool same = *sample.min <= value && value <= *sample.max;
  fmt::print("  {} [{}, {}], the range of the {} recorded\n",
             same ? "lies in" : "NOT as recorded: lies outside", *sample.min, *sample.max,
             sample.secondaries);
  return same;
}

/// True if the record does not contradict the observation.
bool print_observation(const TestWork& work, const reports::Test& recorded, std::uint64_t index) {
  const Question& question = work.outcome.question;
  const std::uint64_t drawn = most_recorded(recorded);
  if (index >= drawn) {
    refuse({}, "observation {} was not drawn: the test used 0 to {}", index, drawn - 1);
  }
  bool same = true;
  for (std::size_t i = 0; i < work.pools.size(); ++i) {
    const Pool& pool = *work.pools[i];
    const Subject& side = question.subjects[i];
    const bool taken = index < side.secondaries(drawn);
    if (pool.is_ready_made() || !taken) {
      fmt::print("{}  has {}\n", side.estimator->name,
                 taken ? "the moments of a run, not its observations" : "no such observation");
      continue;
    }
    std::vector<double> values;
    try {
      values = draw_observation(*pool.setup(), pool.key(), pool.primaries(), index);
    } catch (...) {
      const Fault fault{.observation = index, .words = words_of(std::current_exception())};
      throw std::runtime_error(sentence_of(fault, question.subjects[i].estimator->name));
    }
    const std::vector<Channel> channels = pool.setup()->channels();
    for (std::size_t c = 0; c < values.size(); ++c) {
      if (channels[c].name == cell_channel && values[c] == no_cell) continue;
      fmt::print("{}.{}  observation {}: {}\n", side.estimator->name, channels[c].name, index,
                 values[c]);
      const reports::Sample* sample = recorded_of(recorded, question, i, c);
      if (sample == nullptr || index >= sample->secondaries) continue;
      same &= print_against(*sample, values[c]);
    }
    if (const auto* draws = dynamic_cast<const SamplerSetup*>(pool.setup().get())) {
      fmt::print("  draw of `{}`: {}\n", draws->name(),
                 draw_text(draws->sampler(), pool.key(), index));
    }
  }
  return same;
}

std::string shown(const reports::Number& value) {
  return value ? fmt::format("{}", *value) : "none";
}

bool same_line(const char* what, const reports::Number& now, const reports::Number& then,
               const std::string& note = "") {
  const bool same = now == then;
  fmt::print("  {:<27} {}{}{}\n", what, shown(now), note,
             same ? "" : fmt::format("   (recorded: {})", shown(then)));
  return same;
}

/// Compares the observations that are not finite.
bool same_nonfinite(const reports::Sample& now, const reports::Sample& then) {
  const bool same = now.nonfinite == then.nonfinite;
  if (same && now.nonfinite == 0) return true;
  fmt::print("  {:<27} {}{}; mean and variance are of the others\n", "not finite", now.nonfinite,
             same ? "" : fmt::format("   (recorded: {})", then.nonfinite));
  return same;
}

/// The p-value beside its logarithm, if a double can hold it.
std::string as_probability(const reports::Number& log10_p) {
  if (!log10_p || *log10_p < -300) return "";
  return fmt::format("   (p = {:.3g})", std::pow(10, *log10_p));
}

/// Prints the new numbers. True if they equal the recorded ones to the last bit, except those made
/// of seconds.
bool print_comparison(const reports::Test& now, const reports::Test& then, bool timed) {
  bool same = true;
  if (then.verdict == reports::Verdict::invalid || then.verdict == reports::Verdict::error) {
    fmt::print("{}, so the numbers below decide nothing: {}\n", reports::to_string(then.verdict),
               then.message);
  }
  for (std::size_t i = 0; i < now.samples.size() && i < then.samples.size(); ++i) {
    fmt::print("{}.{}: {} secondaries of {} primaries\n", now.samples[i].estimator,
               now.samples[i].channel, now.samples[i].secondaries, now.samples[i].primaries);
    same &= same_nonfinite(now.samples[i], then.samples[i]);
    // A cell's number has neither mean nor variance.
    if (now.samples[i].channel == cell_channel) continue;
    same &= same_line("mean", now.samples[i].mean, then.samples[i].mean);
    same &=
        same_line("variance of an observation", now.samples[i].variance, then.samples[i].variance);
  }
  for (std::size_t i = 0; i < now.channels.size() && i < then.channels.size(); ++i) {
    fmt::print("test {} on {}\n", now.method, now.channels[i].name);
    const bool statistic =
        same_line("statistic", now.channels[i].statistic, then.channels[i].statistic);
    const reports::Number& log10_p = now.channels[i].log10_p;
    const bool p = same_line(then.looks.size() > 1 ? "log10 p over the looks" : "log10 p", log10_p,
                             then.channels[i].log10_p, as_probability(log10_p));
    same &= timed || (statistic && p);
  }
  same &= now.channels.size() == then.channels.size() && now.samples.size() == then.samples.size();
  return same;
}

/// Prints new beside recorded numbers. Returns 0 if they are equal. std::runtime_error if a source
/// can no longer be drawn.
int replay(const Recorded& recorded, const ReplayArguments& arguments) {
  const std::unique_ptr<Rebuilt> rebuilt = rebuild(recorded, arguments.record);
  if (arguments.observation) {
    return print_observation(rebuilt->work, recorded.test, *arguments.observation) ? 0 : 1;
  }
  const std::unique_ptr<Progress> progress = make_progress(false);
  sample_in_looks({&rebuilt->work}, rebuilt->pools.all(), {}, *progress);
  stop_if_interrupted();
  const reports::Test now = record_of_test(rebuilt->work, recorded.suite.file, false);
  fmt::print("{}\n{}\n", recorded.test.id, recorded.test.claim);
  if (now.verdict == reports::Verdict::error && recorded.test.verdict != now.verdict) {
    throw std::runtime_error(now.message);
  }
  const bool timed = rebuilt->work.outcome.plan.method.keeps == Keeps::blocks;
  const bool same = print_comparison(now, recorded.test, timed);
  fmt::print("{}\n", !same   ? "NOT the numbers recorded: another version, machine or input file?"
                     : timed ? "the same observations as recorded; seconds do not repeat, and what "
                               "is made of them differs"
                             : "the same numbers as recorded");
  return same ? 0 : 1;
}

}  // namespace

Recorded find_test(const reports::Record& record, const ReplayArguments& arguments, bool by_part) {
  std::vector<Recorded> all;
  std::vector<Recorded> named;
  std::vector<Recorded> parts;
  for (const reports::Suite& suite : record.suites) {
    for (const reports::Test& test : suite.tests) {
      all.push_back({suite, test});
      if (test.id == arguments.test) return all.back();
      if (test.name == arguments.test) named.push_back(all.back());
      if (by_part && test.id.find(arguments.test) != std::string::npos) parts.push_back(all.back());
    }
  }
  if (parts.size() > 1) {
    refuse({}, "{} tests have `{}` in their id; give more of one: {}", parts.size(), arguments.test,
           some_ids(parts));
  }
  if (parts.size() == 1) return parts.front();
  if (named.size() == 1) return named.front();
  const Location where{.file = arguments.record};
  if (!named.empty()) {
    refuse(where, "{} tests have the name `{}`; give the id of one: {}", named.size(),
           arguments.test, some_ids(named));
  }
  const std::string near = meant(arguments.test, all);
  refuse(where, "no test `{}` in this run; {}", arguments.test,
         near.empty() ? "there is: " + some_ids(all) : "did you mean `" + near + "`?");
}

int replay(const ReplayArguments& arguments) {
  const reports::Record record = read_record(arguments.record);
  const Recorded recorded = find_test(record, arguments);
  if (recorded.test.samples.empty()) {
    refuse({.file = arguments.record}, "test `{}` recorded no samples: {}", recorded.test.id,
           recorded.test.message);
  }
  try {
    return replay(recorded, arguments);
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& fault) {
    stop_if_interrupted();
    fmt::print("error: {}\n", fault.what());
    return 1;
  }
}

}  // namespace assay::harness
