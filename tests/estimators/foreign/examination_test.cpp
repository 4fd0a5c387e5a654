// Messages to libraries in the process of the tests whose numbers are no function of the question.
// Programs that answer so are in process_test.cpp and isolated_sampler_test.cpp.

#include "estimators/foreign/examination.h"

#include "estimators/core/thread_seconds.h"
#include "tests/estimators/foreign/library.h"

namespace assay::foreign {
namespace {

using Examination = Library;

/// Why observation 3 of a set-up cannot be had.
std::string trouble(const Setup& setup, std::uint64_t primaries = 1) {
  Cost cost;
  return thrown([&] { draw_one(*setup.make(), 3, primaries, cost); });
}

// In the words of a library in a process of its own, each estimator and all workers alike.
TEST_F(Examination, WhoseObservationsAreNoFunctionOfKeyAndIndexIsRefused) {
  const std::string counts = "static int calls; call->out[0] = ++calls; return 0; ";
  const auto counting = load_as("counting", with_body(counts));
  for (int worker = 0; worker < 2; ++worker) {
    EXPECT_THAT(
        trouble(*counting),
        HasSubstr("counting.so` gave other numbers when it was asked for observation 31 again: "
                  "an observation must be a function of key and index alone"));
  }
  const std::string by_index =
      "AssayStream mine = assay_stream(5, call->random->counter[2]); "
      "call->out[0] = assay_uniform(&mine); return 0; ";
  EXPECT_THAT(trouble(*load_as("by_index", with_body(by_index))),
              HasSubstr("by_index.so` gave the same numbers for two keys: runs of other seeds"));
  const std::string by_key =
      "AssayStream mine = assay_stream(call->random->key[0], 7); double sum = 0; "
      "for (uint64_t i = 0; i < call->primaries; ++i) sum += assay_uniform(&mine); "
      "call->out[0] = sum / (double)call->primaries; return 0; ";
  EXPECT_THAT(
      trouble(*load_as("by_key", with_body(by_key, ", .flags = ASSAY_AVERAGES")), 8),
      HasSubstr("by_key.so` ignores the index: observations 0 to 31 all have the same numbers"));
}

TEST_F(Examination, IsNotTheEstimatorsTime) {
  const auto setup = load(compile_text(with_body(
      "double sum = 0; for (int i = 0; i < 1000000; ++i) sum += assay_uniform(call->random); "
      "call->out[0] = sum; return 0; ")));
  const auto estimator = setup->make();
  const auto seconds_of = [&](std::uint64_t index) {
    const auto seconds = [&] { return thread_seconds() + estimator->seconds_elsewhere(); };
    const double before = seconds();
    draw_one(*estimator, index);
    return seconds() - before;
  };
  const double first = seconds_of(0);
  EXPECT_LT(first, 10 * seconds_of(1));
}

/// Bernoulli observations of probability p, of key and index or of the index alone.
Asking coins(double p, bool with_key) {
  return [p, with_key](const Question& question) {
    Stream random({with_key ? question.key : 7}, question.first);
    return std::vector<double>{random.uniform() < p ? 1.0 : 0.0};
  };
}

std::string verdict_on(const Asking& ask, std::uint64_t key, std::uint64_t offset) {
  const Asking shifted = [&](Question question) {
    question.first += offset;
    return ask(question);
  };
  FirstObservations first{.question = {.key = key, .count = asked_twice(1, 1)}};
  for (Question one = first.question; one.first < first.question.count; ++one.first) {
    first.numbers.push_back(shifted(one)[0]);
  }
  return why_unfit(shifted, first, "coin", 0);
}

// Each of the 6000 is refused with a probability below 1e-6.
TEST(Coins, OfKeyAndIndexAreTaken) {
  EXPECT_EQ(asked_twice(4, 2), 4U);
  EXPECT_EQ(asked_twice(1, 64), 2U);
  for (const double p : {.5, .2, .1, .05, .02, .001}) {
    for (std::uint64_t key = 0; key < 1000; ++key) {
      ASSERT_EQ(verdict_on(coins(p, true), key, 0), "") << p << " " << key;
    }
  }
}

// Fewer than 5 of either outcome among 128 have a probability below 2e-8.
TEST(Coins, OfTheIndexAloneAreRefused) {
  for (const double p : {.5, .7854, .215}) {
    for (std::uint64_t i = 0; i < 500; ++i) {
      ASSERT_THAT(verdict_on(coins(p, false), i, 1000 * i), HasSubstr("for two keys")) << p;
    }
  }
}

TEST_F(Examination, WhoseSamplersDriftIsRefused) {
  const auto drifting = [&](const std::string& name, const std::string& sound,
                            const std::string& drift) {
    std::string source = "static double turn;\n" + ramp_sampler;
    source.replace(source.find(sound), sound.size(), drift);
    return load_as(name, source)->samplers()[0].sampler;
  };
  const auto expect_refusal = [&](const std::string& what, auto ask) {
    for (int again = 0; again < 2; ++again) {
      EXPECT_THAT(
          thrown<std::runtime_error>(ask),
          Says("sampler `ramp`", what + ".so` gave other numbers when it was asked for 1 " + what +
                                     " again: a draw must depend on its stream alone, a density or "
                                     "an evaluation on its point alone"));
    }
  };
  const Point point{.25, 0, 0};
  Stream random({1}, 0);
  const auto draws = drifting("draw", "draw->point[0] = x;", "draw->point[0] = x / ++turn;");
  expect_refusal("draw", [&] { draws->sample(random); });
  const auto densities = drifting("density", "return 2 * p[0];", "return ++turn + p[0];");
  expect_refusal("density", [&] { densities->density(point); });
  const auto evaluations = drifting("evaluation", "(void)p; return 1;", "(void)p; return ++turn;");
  expect_refusal("evaluation", [&] { evaluations->evaluate(point); });
}

}  // namespace
}  // namespace assay::foreign
