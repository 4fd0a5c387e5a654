#include "estimators/stream.h"

#include <Random123/philox.h>

#include <boost/math/distributions/chi_squared.hpp>

#include "tests/estimators/table.h"
#include "tests/prelude.h"

namespace assay {
namespace {

const StreamKey key = stream_key(1, "family/plugin", "{}", 0);
constexpr std::uint64_t observations = 1u << 20;

// p of the chi-square statistic of equiprobable cells.
double equiprobable_p(const std::vector<std::uint64_t>& cells, std::uint64_t total) {
  const double expected = static_cast<double>(total) / static_cast<double>(cells.size());
  double statistic = 0;
  for (const std::uint64_t count : cells) {
    const double difference = static_cast<double>(count) - expected;
    statistic += difference * difference / expected;
  }
  const boost::math::chi_squared law(static_cast<double>(cells.size()) - 1);
  return boost::math::cdf(boost::math::complement(law, statistic));
}

// p of the pairs (x, y) being uniform on the square, in 16 x 16 cells.
double pair_p(const std::function<std::pair<double, double>(std::uint64_t)>& pair) {
  std::vector<std::uint64_t> cells(256);
  for (std::uint64_t i = 0; i < observations; ++i) {
    const auto [x, y] = pair(i);
    ++cells[static_cast<std::size_t>(x * 16) * 16 + static_cast<std::size_t>(y * 16)];
  }
  return equiprobable_p(cells, observations);
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

TEST(Stream, AnObservationCanBeDrawnAgainAlone) {
  Stream once(key, 77);
  Stream again(key, 77);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(once(), again());
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

// The false-alarm rate of each test below is 1e-4.

TEST(Stream, FirstDrawsAreUniformAcrossObservations) {
  std::vector<std::uint64_t> cells(1024);
  for (std::uint64_t i = 0; i < observations; ++i) {
    ++cells[static_cast<std::size_t>(Stream(key, i).uniform() * 1024)];
  }
  EXPECT_GT(equiprobable_p(cells, observations), 1e-4);
}

TEST(Stream, LowBitsAreUniformToo) {
  std::vector<std::uint64_t> cells(1024);
  Stream random(key, 0);
  for (std::uint64_t i = 0; i < observations; ++i) ++cells[random() & 1023];
  EXPECT_GT(equiprobable_p(cells, observations), 1e-4);
}

TEST(Stream, NeighbouringObservationsAreIndependent) {
  EXPECT_GT(pair_p([](std::uint64_t i) {
              return std::pair(Stream(key, 2 * i).uniform(), Stream(key, 2 * i + 1).uniform());
            }),
            1e-4);
}

TEST(Stream, NeighbouringDrawsAreIndependent) {
  Stream random(key, 0);
  EXPECT_GT(pair_p([&](std::uint64_t) {
              const double x = random.uniform();
              return std::pair(x, random.uniform());
            }),
            1e-4);
}

TEST(Stream, ASubstreamIsIndependentOfItsParentAndItsNeighbour) {
  EXPECT_GT(pair_p([](std::uint64_t i) {
              Stream parent(key, i);
              return std::pair(parent.uniform(), parent.substream(0).uniform());
            }),
            1e-4);
  EXPECT_GT(pair_p([](std::uint64_t i) {
              const Stream parent(key, i);
              return std::pair(parent.substream(0).uniform(), parent.substream(1).uniform());
            }),
            1e-4);
}

TEST(Stream, NeighbouringSeedsAreIndependent) {
  EXPECT_GT(pair_p([](std::uint64_t i) {
              return std::pair(Stream(stream_key(2 * i, "a/b", "", 0), 0).uniform(),
                               Stream(stream_key(2 * i + 1, "a/b", "", 0), 0).uniform());
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
