#include "estimators/core/first_words.h"

#include "estimators/catalogue.h"
#include "tests/prelude.h"

namespace assay {
namespace {

// All sizes up to two batches and a rest, also where the observation's upper word changes.
TEST(FirstWords, AreThoseOfTheStreams) {
  const StreamKey key = stream_key(1, "family/plugin", "{}", 0);
  for (const std::uint64_t first : {std::uint64_t{0}, std::uint64_t{0xFFFFFFF9}}) {
    for (std::size_t count = 0; count < 20; ++count) {
      std::vector<FirstWords> words(count);
      first_words(key, first, words);
      for (std::size_t i = 0; i < count; ++i) {
        Stream stream(key, first + i);
        EXPECT_EQ(words[i](), stream());
        EXPECT_EQ(words[i](), stream());
      }
    }
  }
}

TEST(FirstWords, AreReadAsAStreamReads) {
  const StreamKey key = stream_key(2, "family/plugin", "{}", 0);
  std::vector<FirstWords> words(100);
  first_words(key, 0, words);
  for (std::size_t i = 0; i < words.size(); ++i) {
    Stream stream(key, i);
    EXPECT_EQ(words[i].uniform_open(), stream.uniform_open());
    EXPECT_EQ(words[i].uniform(), stream.uniform());
  }
}

// Announced or not, in order or not: the same bits.
TEST(FirstWords, GiveALawTheObservationsThatItHasOneByOne) {
  for (const char* law : {"bernoulli(0.3)", "exponential(2)", "lognormal(1, 0.5)", "normal(3, 2)",
                          "student_t(5)", "uniform(-1, 4)", "zero_inflated(0.2)"}) {
    const Entry& entry = find_plugin("analytic/law", {});
    Parameters given("analytic/law", entry.information.parameters,
                     Value::map({{"law", Value::scalar(law)},
                                 {"shift", Value::scalar("1")},
                                 {"scale", Value::scalar("2")}}),
                     "");
    const auto setup = entry.prepare(given);
    const auto announced = setup->make();
    const auto alone = setup->make();
    const StreamKey key = stream_key(1, "analytic/law", given.canonical(), 0);
    announced->announce({.key = key, .first = 100, .last = 1000});
    for (const std::uint64_t index : {100U, 101U, 355U, 356U, 611U, 999U, 500U, 99U, 1000U}) {
      double one = 0;
      double other = 0;
      Cost cost;
      Stream first(key, index);
      Stream second(key, index);
      announced->secondary(first, 1, {&one, 1}, cost);
      alone->secondary(second, 1, {&other, 1}, cost);
      EXPECT_EQ(one, other) << law << ", observation " << index;
      EXPECT_EQ(cost.samples, 2);
    }
  }
}

}  // namespace
}  // namespace assay
