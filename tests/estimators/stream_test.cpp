#include "estimators/stream.h"

#include <Random123/philox.h>

#include <boost/math/distributions/chi_squared.hpp>

#include "tests/estimators/table.h"

namespace assay {
namespace {

const StreamKey key = stream_key(1, "family/plugin", "{}", 0);
constexpr std::uint64_t observations = 1u << 20;

// p of the chi-square statistic of values in [0, 1) in so many equiprobable cells.
double uniform_p(std::size_t count, const std::function<double(std::uint64_t)>& value) {
  std::vector<double> cells(count);
  for (std::uint64_t i = 0; i < observations; ++i) {
    ++cells[static_cast<std::size_t>(value(i) * static_cast<double>(count))];
  }
  const double expected = static_cast<double>(observations) / static_cast<double>(count);
  double statistic = 0;
  for (const double n : cells) statistic += (n - expected) * (n - expected) / expected;
  const boost::math::chi_squared law(static_cast<double>(count) - 1);
  return boost::math::cdf(boost::math::complement(law, statistic));
}

// From any place in the stream on, in a substream, and of an observation of many digits.
TEST(Stream, HasTheSameWordsDrawnAhead) {
  for (const std::uint64_t observation : {std::uint64_t{64}, std::uint64_t{0x1'2345'6789}}) {
    const Stream start(key, observation);
    for (const Stream& stream : {start, start.substream(0x89abcdef)}) {
      for (int before = 0; before < 20; ++before) {
        Stream one = stream;
        Stream ahead = stream;
        for (int i = 0; i < before; ++i) ASSERT_EQ(ahead(), one());
        ahead.draw_ahead();
        for (int i = 0; i < 100; ++i) ASSERT_EQ(ahead(), one());
      }
    }
  }
}

TEST(Stream, IsPhiloxAsDefined) {
  for (const auto& row : tests::table("philox.csv")) {
    std::array<std::uint32_t, 10> n{};
    for (std::size_t i = 0; i < n.size(); ++i)
      n[i] = static_cast<std::uint32_t>(std::stoul(row[i]));
    const PhiloxCounter block = philox({n[0], n[1], n[2], n[3]}, {n[4], n[5]});
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(block[i], n[6 + i]);
  }
}

// Random123 is by the authors of Philox.
TEST(Stream, IsThePhiloxOfItsAuthors) {
  PhiloxCounter counter = {};
  for (std::uint32_t i = 0; i < 10000; ++i) {
    const PhiloxKey key_of_i = {i * 0x9E3779B9, ~i};
    const auto theirs = r123::Philox4x32{}({{counter[0], counter[1], counter[2], counter[3]}},
                                           {{key_of_i[0], key_of_i[1]}});
    counter = philox(counter, key_of_i);
    for (std::size_t word = 0; word < 4; ++word) ASSERT_EQ(counter[word], theirs[word]);
  }
}

TEST(Stream, CounterIsDrawSubstreamObservation) {
  int checked = 0;
  for (const auto& row : tests::table("philox.csv")) {
    const auto word = [&](std::size_t i) { return std::stoull(row[i]); };
    if (word(4) != 0x89ABCDEF) continue;
    const Stream whole({word(5) << 32 | word(4)}, word(3) << 32 | word(2));
    Stream stream = word(1) == 0 ? whole : whole.substream(static_cast<std::uint32_t>(word(1)) - 1);
    for (std::uint64_t skipped = 0; skipped < 2 * word(0); ++skipped) stream();
    EXPECT_EQ(stream(), word(7) << 32 | word(6));
    EXPECT_EQ(stream(), word(9) << 32 | word(8));
    ++checked;
  }
  EXPECT_EQ(checked, 18);
}

TEST(Stream, ASubstreamDoesNotDependOnWhatWasDrawnBefore) {
  Stream parent(key, 5);
  Stream early = parent.substream(3);
  for (int i = 0; i < 7; ++i) parent();
  Stream late = parent.substream(3);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(early(), late());
}

TEST(Stream, SubstreamsAreDistinct) {
  std::set<std::uint64_t> first;
  for (std::uint64_t observation = 0; observation < 100; ++observation) {
    Stream parent(key, observation);
    first.insert(parent());
    for (std::uint32_t i = 0; i < 100; ++i) first.insert(parent.substream(i)());
  }
  // Two of 10,100 random 64-bit words agree with probability 3e-12.
  EXPECT_EQ(first.size(), 100u * 101u);
}

TEST(Stream, ThereIsOneLevelOfSubstreams) {
  const Stream split = Stream(key, 0).substream(0);
  EXPECT_THROW(split.substream(0), std::logic_error);
  EXPECT_THROW(Stream(key, 0).substream(0xffffffffu), std::logic_error);
}

TEST(Stream, UniformsStayInTheirIntervals) {
  Stream random(key, 0);
  for (int i = 0; i < 100000; ++i) {
    const double u = random.uniform();
    EXPECT_TRUE(u >= 0 && u < 1);
    const double open = random.uniform_open();
    EXPECT_TRUE(open > 0 && open < 1);
  }
}

// False alarms: 1e-4 each. Words are Philox's own (above): what is left are their conversion to
// numbers, and the keys.
TEST(Stream, NumbersAreUniformAndNeighbouringSeedsIndependent) {
  EXPECT_GT(uniform_p(1024, [](std::uint64_t i) { return Stream(key, i).uniform(); }), 1e-4);
  // Pairs in 16 x 16 cells.
  const auto of_seed = [](std::uint64_t seed) {
    return Stream(stream_key(seed, "a/b", "", 0), 0).uniform();
  };
  EXPECT_GT(uniform_p(256,
                      [&](std::uint64_t i) {
                        return (std::floor(16 * of_seed(2 * i)) + of_seed(2 * i + 1)) / 16;
                      }),
            1e-4);
}

TEST(StreamKey, EveryArgumentMatters) {
  std::set<std::uint64_t> keys;
  for (const std::uint64_t seed : {0u, 1u, 2u}) {
    for (const char* plugin : {"", "a", "ab", "a/b", "aaaaaaaa", "aaaaaaaaa"}) {
      for (const char* parameters : {"", "a", "b", "bc", "x=1"}) {
        for (const std::uint32_t copy : {0u, 1u, 2u}) {
          keys.insert(stream_key(seed, plugin, parameters, copy).bits);
        }
      }
    }
  }
  EXPECT_EQ(keys.size(), 3u * 6u * 5u * 3u);
  EXPECT_NE(stream_key(1, "ab", "c", 0), stream_key(1, "a", "bc", 0));
}

// Recorded runs replay only while this holds.
TEST(StreamKey, IsTheDocumentedHash) {
  for (const auto& row : tests::table("stream_key.csv")) {
    const auto copy = static_cast<std::uint32_t>(std::stoull(row[3]));
    EXPECT_EQ(stream_key(std::stoull(row[0]), row[1], row[2], copy).bits, std::stoull(row[4]));
  }
}

TEST(StreamKey, OneBitOfTheSeedFlipsHalfTheKey) {
  int flipped = 0;
  for (int bit = 0; bit < 64; ++bit) {
    const std::uint64_t before = stream_key(1, "a/b", "", 0).bits;
    const std::uint64_t after = stream_key(1 ^ (std::uint64_t{1} << bit), "a/b", "", 0).bits;
    flipped += std::popcount(before ^ after);
  }
  // 4,096 fair bits: mean 2,048, standard deviation 32; 3.89 of them.
  EXPECT_NEAR(flipped, 2048, 125);
}

}  // namespace
}  // namespace assay
