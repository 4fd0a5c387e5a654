#include "estimators/core/first_words.h"

#include "tests/estimators/prelude.h"

namespace assay {
namespace {

// All sizes up to two batches and a rest, also where the observation's upper word changes; as words
// and as numbers.
TEST(FirstWords, AreThoseOfTheStreams) {
  const StreamKey key = stream_key(1, "family/plugin", "{}", 0);
  for (const std::uint64_t first : {std::uint64_t{0}, std::uint64_t{0xFFFFFFF9}}) {
    for (std::size_t count = 0; count < 20; ++count) {
      std::vector<FirstWords> words(count);
      first_words(key, first, words);
      std::vector<FirstWords> numbers = words;
      for (std::size_t i = 0; i < count; ++i) {
        Stream stream(key, first + i);
        EXPECT_EQ(words[i](), stream());
        EXPECT_EQ(words[i](), stream());
        Stream again(key, first + i);
        EXPECT_EQ(numbers[i].uniform_open(), again.uniform_open());
        EXPECT_EQ(numbers[i].uniform(), again.uniform());
      }
    }
  }
}

// Announced or not, in order or not: the same bits.
TEST(FirstWords, GiveALawTheObservationsThatItHasOneByOne) {
  for (const char* law : {"bernoulli(0.3)", "exponential(2)", "lognormal(1, 0.5)", "normal(3, 2)",
                          "student_t(5)", "uniform(-1, 4)", "zero_inflated(0.2)"}) {
    const draws::Prepared plugin =
        draws::prepare("analytic/law", std::string("{shift: 1, scale: 2, law: ") + law + "}");
    const StreamKey key = plugin.key;
    const auto announced = plugin.setup->make();
    const auto alone = plugin.setup->make();
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
