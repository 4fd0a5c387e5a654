#include "harness/draws/draw_cells.h"
#include "harness/draws/sampler_setup.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const std::string none = thrown([] {});

/// A sampler of this domain whose draws are all the same.
class Always final : public Sampler {
 public:
  struct Terms {
    Domain domain;
    SamplerDraw draw = {};
    double rounding = 1e-9;
    std::array<double, 2> bounds = {0, 1};
    double density = 1;
  };
  explicit Always(Terms terms) : terms_(terms) {}

  Domain domain() const override { return terms_.domain; }
  std::array<double, 2> bounds() const override { return terms_.bounds; }
  SamplerDraw sample(Stream&) const override { return terms_.draw; }
  double density(const Point&) const override { return terms_.density; }
  double evaluate(const Point&) const override { return 1; }
  double rounding() const override { return terms_.rounding; }

 private:
  Terms terms_;
};

NamedSampler always(const Always::Terms& terms) {
  return {"s", std::make_shared<const Always>(terms)};
}

Point settled(const Always::Terms& terms, const Point& point) {
  return sound(always(terms), {.point = point, .density = 1}).point;
}

std::string refused(const Always::Terms& terms, const SamplerDraw& draw) {
  return thrown<std::runtime_error>([&] { sound(always(terms), draw); });
}

std::string refused(const Always::Terms& terms, const Point& point) {
  return refused(terms, SamplerDraw{.point = point, .density = 1});
}

TEST(SoundDraw, ADirectionMustHaveLengthOne) {
  for (const Domain domain : {Domain::hemisphere, Domain::sphere}) {
    EXPECT_EQ(refused({domain}, Point{0, 0, 2}),
              "sampler `s` drew (0, 0, 2), whose length is 2: a direction must have length 1");
    EXPECT_NE(refused({domain}, Point{.6, 0, .7}), none);
    EXPECT_NE(refused({domain}, Point{0, 0, 0}), none);
    EXPECT_NE(refused({domain}, Point{0, 0, 1.0002}), none);
    EXPECT_NE(refused({domain}, Point{0, nan, 1}), none);
    EXPECT_EQ(refused({domain}, Point{0, 0, 1.00005}), none);
    EXPECT_EQ(refused({domain}, Point{0.6F, 0, 0.8F}), none);
    EXPECT_EQ(refused({.domain = domain, .rounding = 1e-3}, Point{0, 0, 1.0005}), none);
  }
}

TEST(SoundDraw, APointOutsideItsDomainIsNamedInItsWords) {
  EXPECT_EQ(refused({Domain::hemisphere}, Point{.8, 0, -.6}),
            "sampler `s` drew (0.8, 0, -0.6), outside its hemisphere (z >= 0)");
  EXPECT_EQ(refused({Domain::square}, Point{.5, 1.25, 0}),
            "sampler `s` drew (0.5, 1.25), outside its square (u and v from 0 to 1)");
  EXPECT_EQ(refused({Domain::triangle}, Point{.75, .5, 0}),
            "sampler `s` drew (0.75, 0.5), outside its triangle (u >= 0, v >= 0, u + v <= 1)");
  EXPECT_EQ(refused({.domain = Domain::interval, .bounds = {-1, 2}}, Point{2.25, 0, 0}),
            "sampler `s` drew 2.25, outside its interval [-1, 2]");
  for (const Domain domain : {Domain::interval, Domain::square, Domain::triangle}) {
    EXPECT_NE(refused({domain}, Point{nan, .5, 0}), none);
    EXPECT_NE(refused({domain}, Point{-.001, .5, 0}), none);
  }
  EXPECT_NE(refused({Domain::square}, Point{.5, nan, 0}), none);
  EXPECT_NE(refused({Domain::triangle}, Point{.5, -.001, 0}), none);
}

TEST(SoundDraw, RoundingIsTakenToTheBorder) {
  const Point grazing{1, 0, -3e-8};
  EXPECT_EQ(settled({Domain::hemisphere}, grazing), (Point{1, 0, 0}));
  EXPECT_EQ(settled({Domain::sphere}, grazing), grazing);
  EXPECT_EQ(settled({.domain = Domain::interval, .bounds = {.1, .2}}, {0.2F, 0, 0})[0], .2);
  EXPECT_EQ(settled({.domain = Domain::interval, .bounds = {1000.1, 1000.2}}, {1000.2F, 0, 0})[0],
            1000.2);
  EXPECT_EQ(settled({Domain::square}, {-1e-7, 1.0000001, 0}), (Point{0, 1, 0}));
  EXPECT_EQ(settled({Domain::triangle}, {-1e-7, .5, 0}), (Point{0, .5, 0}));
  // Rounding counts as far as the sampler declares it, and no further.
  EXPECT_EQ(settled({.domain = Domain::square, .rounding = 1e-3}, {1.0005, 0, 0})[0], 1);
  EXPECT_NE(refused({.domain = Domain::square, .rounding = 1e-3}, Point{1.002, 0, 0}), none);
  EXPECT_NE(refused({Domain::square}, Point{1.00001, 0, 0}), none);
  EXPECT_NE(refused({.domain = Domain::interval, .bounds = {.1, .2}}, Point{.20001, 0, 0}), none);
}

// To the last bit: what is drawn and counted is no other than without a look at it.
TEST(SoundDraw, APointInItsDomainStaysAsItIs) {
  const double almost = std::nextafter(1.0, 0.0);
  for (const Point& point : {Point{.1F, .7F, 0}, Point{0, almost, 0}, Point{1, 0, 0}}) {
    for (const Domain domain : {Domain::interval, Domain::square, Domain::triangle}) {
      EXPECT_EQ(settled({domain}, point), point);
    }
  }
  const Point direction{0.6F, 1e-20, 0.8F};
  EXPECT_EQ(settled({Domain::hemisphere}, direction), direction);
  const Point below{0.6F, 0, -0.8F};
  EXPECT_EQ(settled({Domain::sphere}, below), below);
}

TEST(SoundDraw, ACellIsFoundForEveryPointThatRoundingMoved) {
  const auto cell = [](const Always::Terms& terms, const Point& point) {
    const SamplerSetup setup(always(terms));
    return DrawCells(setup.sampler()).index(sound(setup.named(), {.point = point, .density = 1}));
  };
  const auto same = [&](const Always::Terms& terms, const Point& moved, const Point& border) {
    EXPECT_EQ(cell(terms, moved), cell(terms, border));
  };
  same({Domain::hemisphere}, {.6, .8, -3e-8}, {.6, .8, 0});
  same({Domain::triangle}, {.25, .75000006, 0}, {.25, .75, 0});
  same({Domain::triangle}, {1.0000001, 1e-7, 0}, {1, 1e-300, 0});
  same({Domain::square}, {1.0000001, -1e-7, 0}, {1, 0, 0});
  same({.domain = Domain::interval, .bounds = {.1, .2}}, {0.2F, 0, 0}, {.2, 0, 0});
}

TEST(SoundDraw, ADensityBelowZeroAndALobeThatIsNoneAreNamed) {
  EXPECT_EQ(refused({Domain::square}, {.point = {.5, .25, 0}, .density = -.125}),
            "sampler `s` drew (0.5, 0.25) with density -0.125: a density must be >= 0");
  EXPECT_EQ(refused({Domain::square}, {.density = 1, .lobe = 3}),
            "sampler `s` drew from lobe 3, and declares 1");
  EXPECT_EQ(refused({Domain::square}, {.point = {9, 9, 9}, .density = -1, .valid = false}), none);
}

/// Why the first observation of a set-up cannot be had.
std::string trouble(const Setup& setup) {
  std::vector<double> out(setup.channels().size());
  Stream random({}, 0);
  Cost cost;
  return thrown([&] { setup.make()->secondary(random, 1, out, cost); });
}

// Also where every draw agrees with what is declared, and where draws are fetched ahead.
TEST(SoundDraw, IsAskedOfEveryClaimOnDraws) {
  const SamplerDraw outside{.point = {2, 0, 0}, .density = 1, .weight = 1};
  const SamplerDraw negative{.point = {.5, 0, 0}, .density = -1, .weight = -1};
  const Always::Terms interval{.domain = Domain::interval, .draw = outside};
  const Always::Terms below{.domain = Domain::interval, .draw = negative, .density = -1};
  const std::string place = "sampler `s` drew 2, outside its interval [0, 1]";
  const std::string density = "sampler `s` drew 0.5 with density -1: a density must be >= 0";
  EXPECT_EQ(trouble(SamplerSetup(always(interval))), place);
  EXPECT_EQ(trouble(ConsistencySetup(always(interval))), place);
  EXPECT_EQ(trouble(SamplerSetup(always(below))), density);
  EXPECT_EQ(trouble(ConsistencySetup(always(below))), density);
}

TEST(SoundDraw, ADeclaredDensityBelowZeroIsNamedWithItsPoint) {
  const SamplerDraw draw{.point = {.5, 0, 0}, .density = 1, .weight = -1};
  const Always::Terms below{.domain = Domain::interval, .draw = draw, .density = -1};
  EXPECT_EQ(trouble(ConsistencySetup(always(below))),
            "sampler `s` declares the density -1 at 0.5: a density must be non-negative and "
            "finite");
  for (const Domain domain : {Domain::interval, Domain::hemisphere}) {
    const SamplerSetup setup(always({.domain = domain, .density = -1}));
    const std::string cells = thrown<std::domain_error>([&] { setup.density_cells(); });
    const std::string law = thrown<std::domain_error>(
        [&] { setup.marginal_law(domain == Domain::interval ? "x" : "theta"); });
    EXPECT_TRUE(cells.starts_with("sampler `s` declares the density -1 at ")) << cells;
    EXPECT_TRUE(law.starts_with("sampler `s` declares the density -1 at ")) << law;
  }
}

}  // namespace
}  // namespace assay::harness
