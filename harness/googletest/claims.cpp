#include "harness/googletest/claims.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "estimators/core/quoting.h"
#include "estimators/estimator.h"
#include "harness/base/refuse.h"
#include "harness/base/terminal.h"
#include "harness/command/options.h"
#include "harness/pilot/pilot.h"
#include "harness/plan/plan.h"
#include "harness/record/record_of.h"
#include "harness/run/evaluate.h"
#include "harness/run/planned_run.h"
#include "harness/sampling/prepare.h"
#include "harness/suite/yaml.h"
#include "harness/theta/ask.h"
#include "reports/words/describe.h"
#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::googletest {
namespace {

using harness::Suite;
using harness::TestWork;

/// The budget, and the numbers of claims made.
struct Spent {
  std::optional<ClaimBudget> budget = {};
  std::uint64_t claims = 0;
  std::uint64_t in_test = 0;
};
Spent& spent() {
  static Spent state;
  return state;
}

/// Each repetition of the tests makes all claims again.
class Counting : public testing::EmptyTestEventListener {
  void OnTestIterationStart(const testing::UnitTest&, int) override { spent().claims = 0; }
  void OnTestStart(const testing::TestInfo&) override { spent().in_test = 0; }
  void OnTestEnd(const testing::TestInfo&) override { spent().in_test = 0; }
};

std::string current_test() {
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  if (test == nullptr) return "outside of a test";
  return std::string(test->test_suite_name()) + "." + test->name();
}

Entry entry_of(bool averages) {
  return {.information = {.name = "googletest",
                          .summary = "a callable",
                          .description = "A callable of a test.",
                          .averages = averages}};
}

/// `stream` separates its random numbers from those of the binary's other sources.
harness::PreparedEstimator prepared(const Source& source, const std::string& stream) {
  static const Entry averaging = entry_of(true);
  static const Entry whole = entry_of(false);
  return {.name = source.name,
          .listed = source.name,
          .entry = source.averages ? &averaging : &whole,
          .setup = source.setup,
          .key_plugin = "googletest",
          .key_parameters = stream,
          .primaries = source.averages ? std::optional<std::uint64_t>() : 1,
          .original = nullptr};
}

/// Draws the first observations again. Names the source that gives others; "" if none does.
std::string unrepeated(const TestWork& work) {
  constexpr std::size_t most = 8;
  for (std::size_t side = 0; side < work.pools.size(); ++side) {
    const harness::Pool& pool = *work.pools[side];
    const harness::Sample sample = work.sample(side);
    const auto* const drawn = std::get_if<harness::Drawn>(&sample);
    if (drawn == nullptr) continue;
    const std::string& name = work.outcome.question.subjects[side].estimator->name;
    const std::unique_ptr<Estimator> estimator = pool.setup()->make();
    std::vector<double> again(pool.channels());
    for (std::size_t i = 0; i < std::min(most, drawn->values(0).size()); ++i) {
      try {
        pool.draw_again(*estimator, i, again);
      } catch (...) {
        return fmt::format("`{}` cannot draw observation {} again: {}", name, i,
                           harness::words_of(std::current_exception()));
      }
      for (std::size_t channel = 0; channel < again.size(); ++channel) {
        const double before = drawn->values(channel)[i];
        const bool no_numbers = std::isnan(before) && std::isnan(again[channel]);
        if (before == again[channel] || no_numbers) continue;
        return fmt::format(
            "`{}` gave {} for observation {}, and {} when it was drawn again: take all random "
            "numbers from its argument, the stream",
            name, reports::round_trip(before), i, reports::round_trip(again[channel]));
      }
    }
  }
  return "";
}

/// Tests the claim alone at its share of the budget. `stream` separates its random numbers from
/// those of the binary's other claims.
reports::Test tested(const std::string& claim, const std::vector<Part>& parts,
                     const std::string& stream, const ClaimBudget& budget) {
  std::map<std::string, harness::PreparedEstimator> estimators;
  harness::TestKeys keys;
  for (const Part& part : parts) {
    if (const auto* key = std::get_if<Key>(&part)) keys[key->name] = key->text;
    const auto* const source = std::get_if<Source>(&part);
    if (source == nullptr) continue;
    const auto its = prepared(*source, stream + "/" + source->name);
    if (!estimators.emplace(source->name, its).second) {
      harness::refuse({}, "two sources are named `{}`", source->name);
    }
  }
  const std::string given = harness::system_environment("ASSAY_SEED");
  const std::uint64_t seed = given.empty() ? budget.seed : harness::read_seed(given, "ASSAY_SEED");
  Suite suite{.name = "googletest",
              .stem = "googletest",
              .alpha = budget.alpha / static_cast<double>(budget.claims),
              .beta = budget.beta};
  suite.tests = {harness::test_of("check", claim, keys)};
  suite.tests[0].where = {};
  const harness::Question question = harness::ask_as_written(suite.tests[0], estimators, seed);
  const harness::Pilots pilots = harness::pilots_of({question}, seed, *harness::threads());
  TestWork work{.outcome = harness::plan_alone(suite, question, pilots)};
  harness::Pools pools;
  work.pools = pools.for_question(question, work.outcome.plan, seed, pilots);
  harness::sample_in_looks({&work}, pools.all(), {}, harness::silence);
  reports::Test test = harness::record_of_test(work, "");
  const bool drawn = test.verdict != reports::Verdict::error;
  if (std::string why = drawn ? unrepeated(work) : ""; !why.empty()) {
    test.verdict = reports::Verdict::error;
    test.message = std::move(why);
    test.advice.reset();
  }
  return test;
}

/// Writes the properties of this test's claim of that number.
void record(const reports::Test& test, std::uint64_t number) {
  const reports::Channel channel = reports::worst_channel(test);
  const auto text = [](const reports::Number& x) { return x ? reports::round_trip(*x) : ""; };
  const std::map<std::string, std::string> properties{
      {"verdict", reports::to_string(test.verdict)},
      {"method", test.method},
      {"estimate", text(channel.effect.estimate)},
      {"low", text(channel.effect.low)},
      {"high", text(channel.effect.high)},
      {"log10_p", text(channel.log10_p)},
      {"secondaries", test.samples.empty() ? "" : std::to_string(test.samples[0].secondaries)}};
  for (const auto& [name, value] : properties) {
    if (!value.empty()) testing::Test::RecordProperty(fmt::format("{}_{}", name, number), value);
  }
}

/// The text in lines of 80 columns, the first as GoogleTest shows it.
std::string in_lines(const std::string& text) {
  const std::string lead = "  Actual: false (";
  return harness::wrapped_message(lead + text, "").substr(lead.size());
}

testing::AssertionResult refused(const std::string& why) {
  return testing::AssertionFailure() << in_lines(why);
}

testing::AssertionResult judged(const std::string& claim, const std::vector<Part>& parts) {
  Spent& state = spent();
  if (!state.budget) {
    return refused(
        "no error budget: declare how many claims the binary makes, as in `const "
        "assay::googletest::DeclaredClaims budget{{.claims = 5}};`");
  }
  if (++state.claims > state.budget->claims) {
    return refused(
        fmt::format("this is claim {} of a binary that declared {}: raise `claims` of its "
                    "DeclaredClaims",
                    state.claims, state.budget->claims));
  }
  const std::uint64_t number = ++state.in_test;
  testing::Test::RecordProperty(fmt::format("claim_{}", number), claim);
  const reports::Test test =
      tested(claim, parts, fmt::format("{}#{}", current_test(), number), *state.budget);
  record(test, number);
  const bool holds = test.verdict == reports::Verdict::pass;
  std::string whole = reports::plain_text(test);  // "message: …" and further facts
  whole.replace(0, whole.find(':'), reports::to_string(test.verdict));
  std::string text;
  std::istringstream lines(whole);
  for (std::string line; std::getline(lines, line);) {
    text += text.empty() ? in_lines(line) : harness::wrapped_message(line, "");
  }
  const std::string again = fmt::format(
      "{} --gtest_filter={}", shell_quoted(program_invocation_name), shell_quoted(current_test()));
  text += fmt::format("replay: {}\n", fmt::join(reports::wrap_command(again, 72), "\n        "));
  return (holds ? testing::AssertionSuccess() : testing::AssertionFailure()) << text;
}

}  // namespace

Source primary(const std::string& name, std::function<double(Stream&)> estimate, double low,
               double high) {
  const Channel channel{.name = "value", .low = low, .high = high};
  return {name, averaging(channel, std::move(estimate)), true};
}

Source secondary(const std::string& name, std::size_t channels,
                 std::function<void(Stream&, std::span<double>)> estimate, double low,
                 double high) {
  SetupParts parts{
      .make = estimating([estimate = std::move(estimate)](Stream& random, std::uint64_t primaries,
                                                          std::span<double> out, Cost& cost) {
        estimate(random, out);
        cost.samples += primaries;
      })};
  for (std::size_t i = 1; i <= channels; ++i) {
    parts.channels.push_back(
        {.name = channels == 1 ? "value" : "value" + std::to_string(i), .low = low, .high = high});
  }
  return {name, setup_of(std::move(parts)), false};
}

Key detect(const std::string& text) { return {"detect", text}; }
Key allow(const std::string& text) { return {"allow", text}; }
Key secondaries(std::uint64_t count) { return {"secondaries", std::to_string(count)}; }

testing::AssertionResult claim_holds(const std::string& claim, const std::vector<Part>& parts) {
  try {
    return judged(claim, parts);
  } catch (const InputError& error) {
    return refused(claim + ": " + error.message());
  }
}

DeclaredClaims::DeclaredClaims(const ClaimBudget& budget) {
  if (budget.claims == 0 || !harness::is_error_rate(budget.alpha) ||
      !harness::is_error_rate(budget.beta)) {
    throw std::logic_error("DeclaredClaims: claims from 1 on, alpha and beta in [1e-9, 0.5]");
  }
  if (spent().budget) throw std::logic_error("DeclaredClaims: a binary has one budget");
  spent().budget = budget;
  testing::UnitTest::GetInstance()->listeners().Append(new Counting);
}

}  // namespace assay::googletest
