// Power lost to a large cell, by the largest share of a density's mass that a cell may hold. Normal
// peaks of several widths lie at the pole of coordinates and beside it, in a unit square. The grid
// has 16 x 32 cells. The chi-square test is at .01, on 400 samples of 10,000 points of each kind:
//   wide    A peak 3 % wider.
//   moved   The peak, with a tenth of the points of one quarter mirrored at its middle.
//   spot    The peak, with half of the points in a spot of 1 % of its mass mirrored so.

#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>
#include <vector>

#include "stats/cells/chi_square.h"
#include "tests/philox.h"
#include "tests/stats/point_by_point.h"

namespace {

using namespace assay::stats;
using assay::tests::even_borders;
using assay::tests::Philox;
using assay::tests::point_by_point;

constexpr int points = 10'000;
constexpr int samples = 400;
constexpr double u = .4;
constexpr double v = .7;

struct Peak {
  double deviation;
  bool at_pole;
};

// The peak in its coordinates; at the pole those are the distance from it and the azimuth in turns.
AdaptiveCells cells_of(const Peak& peak, double share) {
  const double variance = peak.deviation * peak.deviation;
  const auto beside = [&](double x, double y) {
    const double r2 = (x - u) * (x - u) + (y - v) * (y - v);
    return std::exp(-r2 / (2 * variance)) / (2 * std::numbers::pi * variance);
  };
  const auto about = [&](double radius, double) {
    return radius / variance * std::exp(-radius * radius / (2 * variance));
  };
  const PlaneDensity density{
      .x = {0, 1},
      .y = {0, 1},
      .values = peak.at_pole ? point_by_point(about) : point_by_point(beside),
      .x_panels = {100},
      .y_panels = {peak.at_pole ? 1U : 100U}};
  return adaptive_cells({even_borders(16), even_borders(32)}, density, share);
}

enum class Defect { none, wide, moved, spot };

struct Offset {
  double x;
  double y;
};

Offset place(const Peak& peak, const Offset& at) {
  if (!peak.at_pole) return {u + at.x, v + at.y};
  const double turns = std::atan2(at.y, at.x) / (2 * std::numbers::pi);
  return {std::hypot(at.x, at.y), turns < 0 ? turns + 1 : turns};
}

Offset drawn(Philox& random, double deviation, Defect defect) {
  const double wide = defect == Defect::wide ? 1.03 : 1;
  const double radius = wide * deviation * std::sqrt(-2 * std::log1p(-random.uniform()));
  const double angle = 2 * std::numbers::pi * random.uniform();
  const Offset at{radius * std::cos(angle), radius * std::sin(angle)};
  // A sixth of a turn, and as far from the middle as .06 of the points.
  const bool in_spot =
      angle < std::numbers::pi / 3 && radius > 1 * deviation && radius < 1.1 * deviation;
  const bool moves = (defect == Defect::moved && at.x > 0 && at.y > 0 && random.uniform() < .1) ||
                     (defect == Defect::spot && in_spot && random.uniform() < .5);
  return moves ? Offset{-at.x, -at.y} : at;
}

bool rejects(const AdaptiveCells& found, Philox& random, const Peak& peak, Defect defect) {
  CellCounts counts{.observed = std::vector<std::uint64_t>(found.cells.size() + 1),
                    .probability = found.mass.probability,
                    .error = found.mass.error};
  for (int i = 0; i < points; ++i) {
    const auto [x, y] = place(peak, drawn(random, peak.deviation, defect));
    const bool inside = x >= 0 && x <= 1 && y >= 0 && y <= 1;
    ++counts.observed[inside ? found.cells.index(x, y) : found.cells.size()];
  }
  counts.probability.push_back(std::max(0.0, 1 - found.mass.total));
  counts.error.push_back(found.mass.total_error);
  const FitOptions options{.probability_tolerance = found.mass.total_error + 1e-9};
  return chi_square_fit(counts, options).test.log_p_upper < std::log(.01);
}

constexpr std::pair<Defect, const char*> defects[] = {{Defect::none, "none"},
                                                      {Defect::wide, "wide"},
                                                      {Defect::moved, "moved"},
                                                      {Defect::spot, "spot"}};

constexpr Peak peaks[] = {{.1, false}, {.03, false}, {.01, false}, {.03, true}, {.01, true}};

}  // namespace

int main() {
  const std::vector<double> shares = {1, 1. / 16, 1. / 32, 1. / 40, 1. / 64, 1. / 256};
  std::printf("peak           defect");
  for (const double share : shares) std::printf("   1/%-4.0f", 1 / share);
  std::printf("\n");
  for (const Peak& peak : peaks) {
    for (const auto& [defect, name] : defects) {
      std::printf("%s %-6g  %-6s", peak.at_pole ? "pole  " : "beside", peak.deviation, name);
      for (const double share : shares) {
        const AdaptiveCells found = cells_of(peak, share);
        Philox random(391);
        int rejected = 0;
        for (int i = 0; i < samples; ++i) rejected += rejects(found, random, peak, defect);
        std::printf("  %6.3f", static_cast<double>(rejected) / samples);
      }
      std::printf("\n");
      std::fflush(stdout);
    }
  }
}
