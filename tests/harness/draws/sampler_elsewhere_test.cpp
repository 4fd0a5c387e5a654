// Samplers that answer for a few at a time, as those in another process do, and not for every
// point.

#include "harness/draws/sampler_setup.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// A ramp on [0, 1]. One draw in four yields no point, one in eight is inconsistent.
class Ramp : public Sampler {
 public:
  Domain domain() const override { return Domain::interval; }
  SamplerDraw sample(Stream& random) const override {
    const double kind = random.uniform();
    const double x = std::sqrt(random.uniform());
    if (kind < .25) return {.valid = false};
    return {.point = {x, 0, 0}, .density = 2 * x, .weight = (kind < .375 ? 1.1 : 1) / (2 * x)};
  }
  double density(const Point& p) const override { return 2 * p[0]; }
  double evaluate(const Point&) const override { return 1; }
};

struct Limits {
  std::size_t at_once = 1;
  std::size_t points_at_once = 5000;
  double density_below = never;     ///< at x from here on there is no density
  double evaluation_below = never;  ///< and no evaluation
  std::size_t draws_before = 0;     ///< observation of which there is no draw; 0: of each there is
};

class Elsewhere final : public Ramp {
 public:
  explicit Elsewhere(Limits limits) : limits_(limits) {}

  double density(const Point& p) const override {
    require(p[0] < limits_.density_below, "density");
    return Ramp::density(p);
  }
  std::size_t samples(std::span<const Stream> random, std::span<SamplerDraw> draws) const override {
    ++asked;
    ++asked_for_draws;
    return some(random.size(), [&](std::size_t i) {
      require(limits_.draws_before == 0 || random[i].observation() != limits_.draws_before, "draw");
      Stream stream = random[i];
      draws[i] = sample(stream);
    });
  }
  std::size_t densities(std::span<const Point> points, std::span<double> out) const override {
    ++asked;
    return some(std::min(points.size(), limits_.points_at_once),
                [&](std::size_t i) { out[i] = density(points[i]); });
  }
  std::size_t evaluations(std::span<const Point> points, std::span<double> out) const override {
    ++asked;
    return some(std::min(points.size(), limits_.points_at_once), [&](std::size_t i) {
      require(points[i][0] < limits_.evaluation_below, "evaluation");
      out[i] = evaluate(points[i]);
    });
  }

  mutable std::size_t asked = 0;
  mutable std::size_t asked_for_draws = 0;

 private:
  static void require(bool there, const char* what) {
    if (!there) throw std::runtime_error(what);
  }
  /// Writes up to the first that cannot be had, and returns the count; throws if that is the first.
  std::size_t some(std::size_t count, const auto& write) const {
    for (std::size_t i = 0; i < std::min(count, limits_.at_once); ++i) {
      try {
        write(i);
      } catch (const std::runtime_error&) {
        if (i == 0) throw;
        return i;
      }
    }
    return std::min(count, limits_.at_once);
  }

  Limits limits_;
};

constexpr std::uint64_t block = 256;

struct Drawn {
  std::vector<std::vector<double>> observations = {};
  std::string trouble = "";
};

/// Draws as a pool does, block by block, up to the first draw that cannot be had.
Drawn draw(const Setup& setup, std::uint64_t count, StreamKey key) {
  Drawn drawn;
  const auto estimator = setup.make();
  for (std::uint64_t i = 0; i < count; ++i) {
    if (i % block == 0) estimator->announce({key, i, i + block});
    std::vector<double> out(setup.channels().size());
    Stream random(key, i);
    Cost cost;
    try {
      estimator->secondary(random, 1, out, cost);
    } catch (const std::exception& error) {
      drawn.trouble = error.what();
      return drawn;
    }
    drawn.observations.push_back(out);
  }
  return drawn;
}

/// The first observation whose point is at `x` or beyond.
std::size_t first_from(double x, StreamKey key) {
  for (std::size_t i = 0;; ++i) {
    Stream random(key, i);
    const SamplerDraw draw = Ramp().sample(random);
    if (draw.valid && draw.point[0] >= x) return i;
  }
}

template <class Kind>
Drawn drawn_by(std::shared_ptr<const Sampler> sampler, std::uint64_t count, StreamKey key = {}) {
  return draw(Kind(NamedSampler{"ramp", std::move(sampler)}), count, key);
}

TEST(SamplerElsewhere, DrawsWhatItDrawsHere) {
  const Drawn draws = drawn_by<SamplerSetup>(std::make_shared<Ramp>(), 1000);
  const Drawn judged = drawn_by<ConsistencySetup>(std::make_shared<Ramp>(), 1000);
  EXPECT_EQ(draws.observations.size(), 1000u);
  EXPECT_GT(std::ranges::count_if(judged.observations, [](const auto& o) { return o[0] > 0; }), 50);
  for (const std::size_t at_once : {1u, 7u, 100u, 5000u}) {
    const auto there = std::make_shared<Elsewhere>(Limits{.at_once = at_once});
    EXPECT_EQ(drawn_by<SamplerSetup>(there, 1000).observations, draws.observations) << at_once;
    EXPECT_EQ(drawn_by<ConsistencySetup>(there, 1000).observations, judged.observations) << at_once;
  }
}

TEST(SamplerElsewhere, IsAskedForABlockAtATime) {
  const auto there = std::make_shared<Elsewhere>(Limits{.at_once = 5000});
  drawn_by<SamplerSetup>(there, 4 * block);
  EXPECT_EQ(there->asked, 4u);
  drawn_by<ConsistencySetup>(there, 4 * block);
  EXPECT_EQ(there->asked, 16u);
  // Draws are not thrown away because their densities come few at a time.
  const auto hesitant = std::make_shared<Elsewhere>(Limits{.at_once = 5000, .points_at_once = 10});
  drawn_by<ConsistencySetup>(hesitant, 4 * block);
  EXPECT_EQ(hesitant->asked_for_draws, 4u);
}

// Whatever came with it in one question, and also where draws without a point come before it.
TEST(SamplerElsewhere, FailsAtTheObservationThatCannotBeHad) {
  const auto expect_end = [](const Drawn& drawn, std::size_t at, const std::string& trouble) {
    EXPECT_EQ(drawn.observations.size(), at);
    EXPECT_EQ(drawn.trouble, trouble);
  };
  for (const std::size_t at_once : {1u, 2u, 7u, 100u, 5000u}) {
    expect_end(
        drawn_by<SamplerSetup>(
            std::make_shared<Elsewhere>(Limits{.at_once = at_once, .draws_before = 300}), 1000),
        300, "draw");
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const StreamKey key{seed};
      const std::size_t end = first_from(.9, key);
      const Limits no_density{.at_once = at_once, .density_below = .9};
      const Limits no_evaluation{.at_once = at_once, .evaluation_below = .9};
      expect_end(drawn_by<ConsistencySetup>(std::make_shared<Elsewhere>(no_density), 5000, key),
                 end, "density");
      expect_end(drawn_by<ConsistencySetup>(std::make_shared<Elsewhere>(no_evaluation), 5000, key),
                 end, "evaluation");
    }
  }
}

TEST(SamplerElsewhere, ADensityThatCannotBeHadIsAskedForOnce) {
  const auto there = std::make_shared<Elsewhere>(Limits{.at_once = 9, .density_below = .5});
  const SamplerSetup setup(NamedSampler{"ramp", there});
  EXPECT_THROW(setup.marginal_law("x"), NoDensity);
  const std::size_t asked = there->asked;
  EXPECT_GT(asked, 0u);
  EXPECT_THROW(setup.marginal_law("x"), NoDensity);
  EXPECT_THROW(setup.density_cells(), NoDensity);
  EXPECT_EQ(there->asked, asked);
}

TEST(SamplerElsewhere, HasTheTablesThatItHasHere) {
  const SamplerSetup here(NamedSampler{"ramp", std::make_shared<Ramp>()});
  for (const std::size_t at_once : {1u, 4u, 5000u}) {
    const SamplerSetup there(
        NamedSampler{"ramp", std::make_shared<Elsewhere>(Limits{.at_once = at_once})});
    EXPECT_EQ(there.density_cells().mass.probability, here.density_cells().mass.probability);
    EXPECT_EQ(there.marginal_law("x").cumulated, here.marginal_law("x").cumulated);
  }
}

}  // namespace
}  // namespace assay::harness
