#include "harness/sampling/pool.h"

#include "harness/base/work.h"
#include "harness/pilot/pilot.h"
#include "harness/sampling/executor.h"
#include "stats/basics/for_each.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

/// Two channels of a few sums of random numbers; misbehaves at one observation on request.
struct Behaviour {
  std::optional<std::uint64_t> not_a_number = {};
  std::optional<std::uint64_t> throws = {};
  std::optional<std::uint64_t> rows = {};
  bool image = false;
};

class SumsSetup final : public Setup {
 public:
  explicit SumsSetup(Behaviour behaviour = {}) : behaviour_(behaviour) {}
  std::size_t channel_count() const override { return 2; }
  Channel channel(std::size_t) const override { return {}; }
  std::unique_ptr<Estimator> make() const override {
    return estimating([given = behaviour_](Stream& random, std::uint64_t primaries,
                                           std::span<double> out, Cost& cost) {
      if (random.observation() == given.throws) throw std::runtime_error("the lamp burnt out");
      double sum = 0;
      for (std::uint64_t i = 0; i < primaries; ++i) sum += random.uniform();
      out[0] = sum / static_cast<double>(primaries);
      out[1] = std::log(random.uniform_open());
      if (random.observation() == given.not_a_number) {
        out[1] = std::numeric_limits<double>::quiet_NaN();
      }
      cost.samples += primaries;
    })();
  }
  std::optional<std::uint64_t> observations() const override { return behaviour_.rows; }
  std::optional<ImageShape> image() const override {
    if (!behaviour_.image) return std::nullopt;
    return ImageShape{.width = 2, .height = 1};
  }

 private:
  Behaviour behaviour_;
};

struct Wanted {
  std::vector<std::uint64_t> prefixes;
  unsigned threads = 1;
  std::uint64_t primaries = 5;
  Behaviour behaviour = {};
};

std::shared_ptr<Pool> drawn(const Wanted& wanted) {
  const StreamKey key = stream_key(1, "test/sums", "", 0);
  auto pool =
      std::make_shared<Pool>(std::make_shared<SumsSetup>(wanted.behaviour), key, wanted.primaries);
  pool->plans() = {{.histogram_low = 0, .histogram_high = 1, .keep = 700}, {.keep = 20}};
  for (const std::uint64_t count : wanted.prefixes) pool->request(count);
  draw_all({pool}, *threads(wanted.threads), "sampling", silence);
  return pool;
}

/// The first observations of a pool that has drawn them.
Drawn sample_of(const Pool& pool, std::uint64_t count) {
  const Sample sample = pool.sample(count);
  if (const Fault* fault = std::get_if<Fault>(&sample))
    throw std::runtime_error(sentence_of(*fault, "lamp"));
  return std::get<Drawn>(sample);
}

void expect_same(const Summary& one, const Summary& other) {
  EXPECT_EQ(one.count, other.count);
  EXPECT_EQ(one.cost.samples, other.cost.samples);
  ASSERT_EQ(one.channels.size(), other.channels.size());
  for (std::size_t c = 0; c < one.channels.size(); ++c) {
    EXPECT_EQ(one.channels[c].moments, other.channels[c].moments) << "channel " << c;
    EXPECT_EQ(one.details(c).histogram.counts, other.details(c).histogram.counts);
    EXPECT_EQ(one.channels[c].nonfinite, other.channels[c].nonfinite);
  }
}

/// Notes in which order observations are drawn.
std::shared_ptr<const Setup> noting(char name, std::string& order) {
  const auto note = [name, &order](Stream& random, std::uint64_t, std::span<double> out, Cost&) {
    out[0] = random.uniform();
    order += name;
  };
  return setup_of({.channels = {Channel{}}, .make = estimating(note)});
}

// Pools whose seconds are compared are drawn side by side. At any time, equal parts of both are
// drawn, up to a block, though one has four times as many observations.
TEST(Pool, OfWhichSecondsAreComparedAreDrawnSideBySide) {
  std::string order;
  std::vector<std::shared_ptr<Pool>> pools;
  for (const char name : {'a', 'b'}) {
    pools.push_back(
        std::make_shared<Pool>(noting(name, order), stream_key(1, std::string(1, name), "", 0), 1));
    pools.back()->keep_blocks();
    pools.back()->request(name == 'a' ? 200000 : 50000);
  }
  draw_all(pools, *threads(1), "sampling", silence);
  ASSERT_EQ(order.size(), 250000U);
  double drawn_a = 0;
  double drawn_b = 0;
  double farthest = 0;
  for (const char name : order) {
    (name == 'a' ? drawn_a : drawn_b) += 1;
    farthest = std::max(farthest, std::abs(drawn_a / 200000 - drawn_b / 50000));
  }
  const double block = static_cast<double>(pools[1]->block_end(0)) / 50000;
  EXPECT_LE(farthest, 2 * block);
  EXPECT_LT(block, 0.25);
}

TEST(Pool, OfEveryThreadCountHasTheSameBits) {
  const std::vector<std::uint64_t> prefixes{100, 10000, 12345};
  const auto alone = drawn({.prefixes = prefixes, .threads = 1});
  for (const unsigned threads : {2U, 3U, 4U}) {
    const auto together = drawn({.prefixes = prefixes, .threads = threads});
    for (const std::uint64_t count : prefixes) {
      expect_same(sample_of(*together, count).summary(), sample_of(*alone, count).summary());
      EXPECT_EQ(sample_of(*alone, count).summary().count, count);
    }
    EXPECT_TRUE(std::ranges::equal(sample_of(*together, 12345).values(0),
                                   sample_of(*alone, 12345).values(0)));
  }
}

// A pool of 5 primaries, with nothing drawn.
std::shared_ptr<Pool> marked(std::uint64_t count) {
  const StreamKey key = stream_key(1, "test/sums", "", 0);
  auto pool = std::make_shared<Pool>(std::make_shared<SumsSetup>(), key, 5);
  pool->mark(count);
  return pool;
}

void draw_up_to(std::uint64_t count, const std::shared_ptr<Pool>& pool, unsigned threads) {
  pool->request(count);
  draw_all({pool}, *harness::threads(threads), "sampling", silence);
}

// Blocks hold 2048 observations of 5 primaries: prefixes inside, at and beyond their ends.
TEST(Pool, PrefixIsThatOfAPoolDrawnOnlySoFar) {
  const std::vector<std::uint64_t> prefixes{1, 2, 999, 2047, 2048, 2049, 4096, 5000, 9999};
  const auto all = drawn({.prefixes = prefixes, .threads = 2});
  ASSERT_EQ(all->block_size(), 2048);
  for (const std::uint64_t count : prefixes) {
    expect_same(sample_of(*all, count).summary(),
                sample_of(*drawn({.prefixes = {count}}), count).summary());
  }
}

TEST(Pool, DoesNotChangeWhenContinuedLater) {
  const auto pool = marked(9000);
  draw_up_to(3000, pool, 1);
  draw_up_to(9000, pool, 2);
  EXPECT_EQ(sample_of(*pool, 9000).summary().channels[0].moments,
            sample_of(*drawn({.prefixes = {9000}}), 9000).summary().channels[0].moments);
}

TEST(Pool, DrawsNoMoreThanAnyoneMayAskFor) {
  const auto pool = marked(5000);
  draw_up_to(100, pool, 2);
  EXPECT_EQ(pool->drawn(), 2048);
  draw_up_to(5000, pool, 2);
  EXPECT_EQ(pool->drawn(), 5000);
}

// Blocks are drawn whole: 3000 requested draws 4096, and a prefix inside can no longer be taken.
TEST(Pool, RefusesAMarkBehindWhatIsDrawn) {
  const auto pool = marked(9000);
  pool->request(3000);
  EXPECT_EQ(pool->seconds(), 0);
  EXPECT_THROW(pool->sample(3000), std::logic_error) << "before it is drawn";
  draw_up_to(3000, pool, 1);
  EXPECT_EQ(pool->seconds(), sample_of(*pool, 3000).summary().seconds);
  EXPECT_THROW(pool->mark(4000), std::logic_error);
  EXPECT_NO_THROW(pool->mark(3000));
  EXPECT_NO_THROW(pool->mark(5000));
}

TEST(Pool, KeepsTheFirstValuesAsManyAsPlanned) {
  const auto pool = drawn({.prefixes = {10, 20, 700, 5000}, .threads = 2});
  EXPECT_EQ(sample_of(*pool, 5000).values(0).size(), 700);
  EXPECT_EQ(sample_of(*pool, 10).values(0).size(), 10);
  EXPECT_EQ(sample_of(*pool, 5000).values(1).size(), 20);
  for (const std::uint64_t index : {0U, 7U, 19U}) {
    std::array<double, 2> again = {};
    pool->draw_again(*SumsSetup().make(), index, again);
    EXPECT_EQ(sample_of(*pool, 700).values(0)[index], again[0]);
    EXPECT_EQ(sample_of(*pool, 20).values(1)[index], again[1]);
  }
}

TEST(Pool, CountsWhatIsNotFiniteWithItsPlace) {
  const auto pool =
      drawn({.prefixes = {1000, 6000}, .threads = 2, .behaviour = {.not_a_number = 4321}});
  const ChannelSummary& spoilt = sample_of(*pool, 6000).summary().channels[1];
  EXPECT_EQ(spoilt.nonfinite, 1);
  EXPECT_EQ(spoilt.first_nonfinite, 4321);
  EXPECT_EQ(spoilt.moments.count, 5999);
  EXPECT_EQ(sample_of(*pool, 6000).summary().channels[0].nonfinite, 0);
  EXPECT_EQ(sample_of(*pool, 1000).summary().channels[1].nonfinite, 0);
}

TEST(Pool, SaysAtWhichObservationItsEstimatorThrew) {
  const auto pool = drawn({.prefixes = {1000, 6000}, .threads = 2, .behaviour = {.throws = 4321}});
  ASSERT_TRUE(pool->fault());
  EXPECT_EQ(sentence_of(*pool->fault(), "lamp"),
            "`lamp` stopped at observation 4321: the lamp burnt out");
  EXPECT_EQ(std::get<Fault>(pool->sample(6000)).observation, 4321);
  // Observations from before the trouble are still there.
  expect_same(sample_of(*pool, 1000).summary(),
              sample_of(*drawn({.prefixes = {1000}}), 1000).summary());
}

TEST(Pool, TakesWhateverIsThrown) {
  const auto words = [](const auto& thrown) {
    try {
      throw thrown;
    } catch (...) {
      return words_of(std::current_exception());
    }
  };
  EXPECT_EQ(words(std::runtime_error("")), "it threw an exception without words");
  EXPECT_EQ(words(17), "it threw something that is no std::exception");
  EXPECT_EQ(words(std::bad_alloc()), "there is not enough memory (std::bad_alloc)");
  EXPECT_EQ(words(InputError({.file = "rows.txt", .line = 3, .column = 1}, "is short")),
            "rows.txt:3:1: is short");
}

TEST(Pool, DrawsNothingFromASourceThatFailedBefore) {
  const auto pool = marked(1000);
  pool->fail({.words = "it ended in the pilot"});
  draw_up_to(1000, pool, 2);
  EXPECT_EQ(pool->drawn(), 0);
  EXPECT_EQ(std::get<Fault>(pool->sample(1000)).words, "it ended in the pilot");
}

TEST(Pool, OfBoundedDataEndsWhereTheyEnd) {
  const auto pool = drawn({.prefixes = {2500}, .threads = 2, .behaviour = {.rows = 2500}});
  EXPECT_EQ(pool->drawn(), 2500);
  EXPECT_EQ(pool->block_end(2048), 2500);
}

TEST(Pool, HistogramHoldsEveryFiniteValue) {
  const auto pool = drawn({.prefixes = {5000}});
  const Histogram& histogram = sample_of(*pool, 5000).summary().details(0).histogram;
  std::uint64_t total = histogram.below + histogram.above;
  for (const std::uint64_t count : histogram.counts) total += count;
  EXPECT_EQ(total, 5000);
  EXPECT_EQ(histogram.below + histogram.above, 0);
}

std::shared_ptr<Pool> pool_of(Behaviour behaviour) {
  return std::make_shared<Pool>(std::make_shared<SumsSetup>(behaviour), StreamKey{7}, 5);
}

std::shared_ptr<Pool> drawn_from(const std::shared_ptr<Pool>& pool, unsigned threads) {
  pool->request(20);
  draw_up_to(30, pool, threads);
  return pool;
}

// Rows of files are read once, for the pilot, and known to the test.
TEST(Pool, TakesWhatIsKnownWithoutDrawingIt) {
  const auto first = pool_of({.rows = 30});
  first->keep_observations(30);
  draw_up_to(30, first, 1);
  ASSERT_EQ(first->kept()->values.size(), 30U);
  const auto second = pool_of({.throws = 11, .rows = 30});
  second->take_known(first->kept());
  draw_up_to(30, second, 1);
  EXPECT_FALSE(second->fault());
  EXPECT_EQ(sample_of(*second, 30).summary().channels[1].moments.m4,
            sample_of(*first, 30).summary().channels[1].moments.m4);
  EXPECT_EQ(sample_of(*second, 30).summary().cost, sample_of(*first, 30).summary().cost);
}

// Images that are all kept are summed when all are there, once for the pilot and the test.
TEST(Pool, KeptImagesHaveTheSumsOfOneByOne) {
  const Behaviour pictures{.not_a_number = 11, .image = true};
  const auto one_by_one = pool_of(pictures);
  one_by_one->keep_observations(20);
  drawn_from(one_by_one, 1);
  const auto kept = pool_of(pictures);
  kept->keep_observations(30);
  drawn_from(kept, 1);
  const auto two_threads = pool_of(pictures);
  two_threads->keep_observations(30);
  drawn_from(two_threads, 2);
  for (const std::uint64_t count : {20U, 30U}) {
    const Summary& expected = sample_of(*one_by_one, count).summary();
    const Summary& sums = sample_of(*kept, count).summary();
    EXPECT_EQ(sums.count, count);
    EXPECT_EQ(sums.cost, expected.cost);
    ASSERT_EQ(sums.channels.size(), 2U);
    for (std::size_t c = 0; c < 2; ++c) {
      const stats::Moments& moments = sums.channels[c].moments;
      EXPECT_EQ(moments.count, expected.channels[c].moments.count);
      EXPECT_NEAR(moments.mean / expected.channels[c].moments.mean, 1, 1e-14);
      EXPECT_NEAR(moments.m4 / expected.channels[c].moments.m4, 1, 1e-12);
      EXPECT_EQ(sums.channels[c].nonfinite, expected.channels[c].nonfinite);
      EXPECT_EQ(sums.channels[c].first_nonfinite, expected.channels[c].first_nonfinite);
    }
    expect_same(sums, sample_of(*two_threads, count).summary());
  }
  const auto known = pool_of({.not_a_number = 11, .rows = 30, .image = true});
  known->take_known(kept->kept());
  drawn_from(known, 1);
  EXPECT_EQ(&sample_of(*known, 30).summary(), &sample_of(*kept, 30).summary()) << "sums are shared";
  const Images some = sample_of(*known, 30).images(20);
  ASSERT_EQ(some.size(), 20U);
  const Images of_one_by_one = sample_of(*one_by_one, 30).images();
  ASSERT_EQ(of_one_by_one.size(), 20U);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(some[i][0], of_one_by_one[i][0]);
}

// Readers of blocks ask each for the moments of a channel.
TEST(Pool, KeepsNoBlockWhoseFirstObservationFailed) {
  const auto pool = pool_of({.throws = 1024, .image = true});
  ASSERT_EQ(pool->block_size(), 1024);
  pool->keep_observations(3000);
  pool->keep_blocks();
  pool->mark(1024);
  draw_up_to(3000, pool, 1);
  ASSERT_TRUE(pool->fault());
  const std::span<const Summary> blocks = sample_of(*pool, 1024).blocks();
  ASSERT_EQ(blocks.size(), 1U);
  EXPECT_EQ(blocks[0].moments(1).count, 1024);
}

// A sampler's tests do not read its estimator: the estimator's death is none of theirs.
TEST(Pilots, FaultOfAnEstimatorIsNotItsSamplers) {
  Pilots pilots;
  pilots.add("lamp", Fault{.words = "it burnt out"});
  EXPECT_NE(pilots.fault("lamp"), nullptr);
  EXPECT_EQ(pilots.fault("lamp.cells"), nullptr);
  pilots.add("lamp.cells", Fault{.words = "no filament"});
  ASSERT_NE(pilots.fault("lamp.cells"), nullptr);
  EXPECT_EQ(pilots.fault("lamp.cells")->words, "no filament");
}

}  // namespace
}  // namespace assay::harness
