#include "harness/draws/sampler_setup.h"

#include "tests/harness/prelude.h"
#include "tests/harness/questions.h"

namespace assay::harness {
namespace {

template <class Kind>
std::shared_ptr<const SamplerSetup> setup_with(const Kind& sampler) {
  return std::make_shared<const SamplerSetup>(
      NamedSampler{"test", std::make_shared<const Kind>(sampler)});
}

// The incident direction is the normal, so the half vector's angle is theta / 2. P(theta <= t) = 1
// - exp(-tan^2(t / 2) / alpha^2), over its value at the horizon (Walter 2005).
TEST(SamplerSetup, PolarAngleOfANarrowLobeFollowsItsClosedForm) {
  for (const double alpha : {0.02, 0.05, 0.4}) {
    const std::string a = std::to_string(alpha);
    const auto setup = setup_of(
        "{plugin: brdf/ward, alpha_x: " + a + ", alpha_y: " + a + ", theta_i: 0}", "direction");
    const stats::TabulatedLaw& law = setup->marginal_law("theta");
    const auto below = [&](double t) { return -std::expm1(-std::pow(std::tan(t / 2) / alpha, 2)); };
    double distance = 0;
    for (int k = 0; k <= 4000; ++k) {
      const double t = pi / 2 * k / 4000;
      distance = std::max(distance, std::abs(law(t) - below(t) / below(pi / 2)));
    }
    EXPECT_LE(distance, law.error) << alpha;
    EXPECT_LT(law.error, 2e-5) << alpha;
    EXPECT_NEAR(law.total(), below(pi / 2), 1e-6) << alpha;
  }
}

TEST(SamplerSetup, AzimuthOfANarrowLobeOffTheNormalIsTabulated) {
  const auto setup = setup_of(
      "{plugin: brdf/ward, alpha_x: 0.02, alpha_y: 0.02, theta_i: 0.8, phi_i: 0.5}", "direction");
  const stats::TabulatedLaw& law = setup->marginal_law("phi");
  // The mirrored direction's azimuth is phi_i + pi, about which the lobe is symmetric.
  EXPECT_NEAR(law(0.5 + pi), 0.5, 1e-5);
  EXPECT_LT(law.error, 2e-5);
  EXPECT_NEAR(law.total(), setup->density_cells().mass.total, 1e-5);
}

TEST(SamplerSetup, ADensityThatJumpsIsTabulatedInBoundedWork) {
  const auto setup = setup_of("{plugin: luminaire/solid_angle, scene: triangle}", "direction");
  for (const char* marginal : {"theta", "phi"}) {
    const stats::TabulatedLaw& law = setup->marginal_law(marginal);
    EXPECT_LT(law.error, 1e-4) << marginal;
    EXPECT_NEAR(law.total(), 1, 1e-5) << marginal;
  }
  EXPECT_LT(setup->density_cells().tolerance(), 1e-4);
  EXPECT_EQ(setup->density_cells().missing(), 0)
      << "what the quadrature's error explains is not missing";
}

TEST(SamplerSetup, ReflectanceBelowTheHorizonIsMissing) {
  const auto setup = setup_of("{plugin: brdf/ward}", "direction");
  EXPECT_NEAR(setup->density_cells().missing(), 1 - 0.980181, 1e-6);
}

TEST(SamplerSetup, IsOneForOneSampler) {
  const auto asked = ask_text(
      "suite: two\nestimators: {e: {plugin: brdf/ward}}\ntests:\n"
      "  - {name: a, claim: distribution(e.direction) == density}\n"
      "  - {name: b, claim: distribution(e.direction.theta) == density}\n");
  EXPECT_EQ(asked->question("a").subjects[0].setup, asked->question("b").subjects[0].setup);
}

// One of the grid's cells has a fifth of the lobe.
TEST(SamplerSetup, ANarrowLobeIsCountedInCellsOfItsOwn) {
  const auto setup = setup_of(
      "{plugin: brdf/ward, alpha_x: 0.02, alpha_y: 0.02, theta_i: 0.8, phi_i: 0}", "direction");
  const DensityCells& density = setup->density_cells();
  EXPECT_GT(density.cells.size(), 512u + 32);
  double heaviest = 0;
  for (std::size_t i = 0; i < density.cells.in_domain(); ++i) {
    heaviest = std::max(heaviest, density.mass.probability[i]);
    EXPECT_LT(density.cells.grid_cell(i), 512u);
  }
  EXPECT_LE(heaviest, 1.0 / 40);
  const auto mirrored = [](double theta) {
    return SamplerDraw{.point = {-std::sin(theta), 0, std::cos(theta)}};
  };
  EXPECT_NE(density.cells.index(mirrored(.77)), density.cells.index(mirrored(.81)));
  const DrawCells grid(setup->sampler());
  EXPECT_EQ(grid.index(mirrored(.77)), grid.index(mirrored(.81)));
}

TEST(SamplerSetup, DrawsAreCountedInCellsOnceTheyAreAskedFor) {
  const auto setup = setup_of("{plugin: brdf/ward}", "direction");
  const auto cell_drawn = [&] {
    const std::unique_ptr<Estimator> estimator = setup->make();
    Stream random({.bits = 7}, 0);
    std::vector<double> out(setup->channels().size());
    Cost cost;
    estimator->secondary(random, 1, out, cost);
    return out.back();
  };
  EXPECT_EQ(setup->cells_asked_for(), nullptr);
  EXPECT_EQ(cell_drawn(), no_cell);
  const DensityCells& cells = setup->density_cells();
  EXPECT_EQ(&cells, setup->cells_asked_for().get());
  EXPECT_GT(cell_drawn(), 0);
}

/// Uniform on its domain.
class Uniform : public Sampler {
 public:
  explicit Uniform(Domain domain) : domain_(domain) {}
  Domain domain() const override { return domain_; }
  SamplerDraw sample(Stream&) const override { return {}; }
  double density(const Point&) const override {
    switch (domain_) {
      case Domain::triangle:
        return 2;
      case Domain::hemisphere:
        return 1 / (2 * pi);
      case Domain::sphere:
        return 1 / (4 * pi);
      default:
        return 1;
    }
  }
  double evaluate(const Point&) const override { return 0; }

 private:
  Domain domain_;
};

class FarAway final : public Uniform {
 public:
  FarAway() : Uniform(Domain::interval) {}
  std::array<double, 2> bounds() const override { return {1000, 1000.5}; }
};

TEST(SamplerSetup, EndsOfACellAreToldApart) {
  const FarAway sampler;
  const DrawCells grid(sampler);
  EXPECT_EQ(grid.describe(0), "x 1000 to 1000.008");
  EXPECT_EQ(grid.describe(64), "the draws without a point");
}

TEST(SamplerSetup, CellsOfEveryDomainHaveNearlyEqualMeasure) {
  for (const Domain domain :
       {Domain::interval, Domain::square, Domain::triangle, Domain::hemisphere, Domain::sphere}) {
    const auto setup = setup_with(Uniform(domain));
    const DensityCells& density = setup->density_cells();
    const stats::PlaneGrid& grid = density.cells.grid();
    // Each border has moved by one cell at most.
    std::vector<double> of_row(grid.rows());
    for (std::size_t cell = 0; cell < density.cells.in_domain(); ++cell) {
      const std::size_t row = density.cells.grid_cell(cell) / grid.columns();
      of_row[row] += density.mass.probability[cell];
    }
    double below = 0;
    const double rows = static_cast<double>(grid.rows());
    for (std::size_t row = 0; row < grid.rows(); ++row) {
      below += of_row[row];
      ASSERT_NEAR(below, static_cast<double>(row + 1) / rows, 1.001 / rows);
    }
    EXPECT_NEAR(below, 1, 1e-9);
    EXPECT_EQ(density.missing(), 0);
  }
}

TEST(SamplerSetup, BordersOfCellsAreThoseOfTheKey) {
  for (const Domain domain : {Domain::interval, Domain::square, Domain::sphere}) {
    const Uniform uniform(domain);
    const stats::PlaneGrid one = shifted_grid(uniform, {1});
    EXPECT_EQ(one.x_borders, shifted_grid(uniform, {1}).x_borders);
    EXPECT_EQ(one.y_borders, shifted_grid(uniform, {1}).y_borders);
    const stats::PlaneGrid other = shifted_grid(uniform, {2});
    EXPECT_EQ(one.size(), other.size());
    for (std::size_t i = 1; i + 1 < one.x_borders.size(); ++i) {
      EXPECT_NE(one.x_borders[i], other.x_borders[i]);
    }
  }
}

/// Uniform below .4, and nothing beyond. It draws on the edge as single precision rounds it.
class HalfEmpty final : public Uniform {
 public:
  explicit HalfEmpty(double leak) : Uniform(Domain::interval), leak_(leak) {}
  double density(const Point& p) const override { return p[0] < .4 ? 2.5 : 0; }
  SamplerDraw sample(Stream& random) const override {
    const double u = random.uniform();
    const bool beyond = random.uniform() < leak_;
    const double x = beyond ? .4 + .6 * u : double{static_cast<float>(.4 * u)};
    return {.point = {u < 1e-3 && !beyond ? .4 + 1e-8 : x, 0, 0}, .density = 2.5, .weight = 1};
  }

 private:
  double leak_;
};

TEST(SamplerSetup, DrawsWhereTheDensityIs0HaveNumbersOfTheirOwn) {
  const HalfEmpty sound(0);
  const HalfEmpty leaking(.01);
  for (const HalfEmpty* sampler : {&sound, &leaking}) {
    const auto setup = setup_with(*sampler);
    const DensityCells& density = setup->density_cells();
    std::vector<std::uint64_t> counts(density.numbers());
    const auto estimator = setup->make();
    std::uint64_t beyond = 0;
    for (std::uint64_t i = 0; i < 20000; ++i) {
      std::array<double, 2> out{};
      Cost cost;
      Stream random({7}, i);
      estimator->secondary(random, 1, out, cost);
      ++counts.at(static_cast<std::size_t>(out[1]));
      beyond += out[0] > .4 + 1e-6 ? 1U : 0U;
    }
    const auto impossible = density.impossible(counts);
    EXPECT_EQ(std::accumulate(impossible.begin(), impossible.end(), std::uint64_t{0}), beyond);
    EXPECT_EQ(beyond > 0, sampler == &leaking);
    const std::vector<std::uint64_t> in_cells = density.in_cells(counts);
    EXPECT_EQ(std::accumulate(in_cells.begin(), in_cells.end(), std::uint64_t{0}), 20000u);
  }
}

/// Two normal peaks of 2e-5 and 1e-4 of the interval.
class Peaks final : public Uniform {
 public:
  Peaks() : Uniform(Domain::interval) {}
  double density(const Point& p) const override {
    return (normal(p[0], .3456789, 2e-5) + normal(p[0], .9, 1e-4)) / 2;
  }
  SamplerDraw sample(Stream& random) const override {
    const bool first = random.uniform() < .5;
    const double z =
        std::sqrt(-2 * std::log(random.uniform_open())) * std::cos(2 * pi * random.uniform());
    return {.point = {first ? .3456789 + 2e-5 * z : .9 + 1e-4 * z, 0, 0}, .weight = 1};
  }

 private:
  static double normal(double x, double mean, double deviation) {
    const double z = (x - mean) / deviation;
    return std::exp(-z * z / 2) / (deviation * std::sqrt(2 * pi));
  }
};

TEST(SamplerSetup, PeaksAreIntegratedWhereTheyAreDrawn) {
  const auto setup = setup_with(Peaks());
  EXPECT_NEAR(setup->density_cells().mass.total, 1, 1e-7);
  const double most = *std::ranges::max_element(setup->density_cells().mass.probability);
  EXPECT_LE(most, 1.0 / 32);
  const stats::TabulatedLaw& law = setup->marginal_law("x");
  EXPECT_NEAR(law(.3456789), .25, 1e-5);
  EXPECT_NEAR(law(.9), .75, 1e-5);
}

// In a triangle of area 1/2 both barycentric coordinates have P(u <= x) = 1 - (1 - x)^2.
TEST(SamplerSetup, MarginalsOfATriangleAreThoseOfItsCoordinates) {
  const auto setup = setup_with(Uniform(Domain::triangle));
  for (const char* marginal : {"u", "v"}) {
    const stats::TabulatedLaw& law = setup->marginal_law(marginal);
    for (const double x : {.01, .3, .77, .999}) {
      EXPECT_NEAR(law(x), 1 - (1 - x) * (1 - x), law.error) << marginal;
    }
  }
}

TEST(SamplerSetup, MarginalsOfASphereAreItsAngles) {
  const auto setup = setup_with(Uniform(Domain::sphere));
  EXPECT_NEAR(setup->marginal_law("theta")(2), (1 - std::cos(2.0)) / 2, 1e-5);
  EXPECT_NEAR(setup->marginal_law("phi")(2), 1 / pi, 1e-5);
}

/// Three parts in ten from a mirror, one in ten nowhere, the rest uniform in two halves.
class Lobes final : public Uniform {
 public:
  Lobes() : Uniform(Domain::square) {}
  double density(const Point& p) const override { return lobe_density(0, p) + lobe_density(1, p); }
  int lobes() const override { return 3; }
  double lobe_density(int lobe, const Point& p) const override {
    if (lobe == 0) return p[0] < .5 ? .8 : 0;
    return lobe == 1 && p[0] >= .5 ? .4 : 0;
  }
  double point_mass(int lobe) const override { return lobe == 2 ? .3 : 0; }
};

TEST(SamplerSetup, LobesAndPointMassesAreCellsOfTheirOwn) {
  const auto setup = setup_with(Lobes());
  const auto p = [&](const SamplerDraw& draw) {
    return setup->density_cells().mass.probability[setup->density_cells().cells.index(draw)];
  };
  const auto area = [&](const SamplerDraw& draw) {
    const DrawCells& cells = setup->density_cells().cells;
    const stats::PlaneCell sides = cells.sides(cells.index(draw));
    return sides.x.width() * sides.y.width();
  };
  const SamplerDraw left{.point = {.1, .1, 0}, .lobe = 0};
  const SamplerDraw right{.point = {.9, .1, 0}, .lobe = 1};
  EXPECT_NEAR(p(left), .8 * area(left), 1e-9);
  EXPECT_NEAR(p({.point = {.1, .1, 0}, .lobe = 1}), 0, 1e-9);
  EXPECT_NEAR(p(right), .4 * area(right), 1e-9);
  EXPECT_NEAR(p({.point = {.9, .1, 0}, .lobe = 2}), .3, 1e-9);
  EXPECT_EQ(setup->density_cells().cells.index({.valid = false}),
            setup->density_cells().cells.size() - 1);
  EXPECT_NEAR(setup->density_cells().missing(), .1, 1e-8);
  EXPECT_NEAR(setup->density_cells().without_density(), .4, 1e-8);
}

}  // namespace
}  // namespace assay::harness
