#include "harness/cell_record.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "harness/sampler_setup.h"

namespace assay::harness {
namespace {

std::string axis(const Marginal& marginal, const std::vector<double>& borders) {
  return fmt::format("{} {:.4g} to {:.4g}", marginal.name, borders.front(), borders.back());
}

/// What rows and columns of the maps are; all cells have the same measure.
std::string axes_of(const SamplerSetup& draws) {
  std::vector<Marginal> coordinates = draws.marginals();
  // Of a triangle the second coordinate of a cell is a share of what the first leaves.
  if (draws.sampler().domain() == Domain::triangle) coordinates[1].name = "v / (1 - u)";
  return fmt::format("{} from top to bottom, {} from left to right",
                     axis(coordinates[0], draws.grid().x_borders),
                     axis(coordinates[1], draws.grid().y_borders));
}

struct Counts {
  std::vector<double> observed, expected;
};

/// Summed over the lobes, whose cells follow one another; what comes behind them has no place.
Counts counts_of(const SamplerSetup& draws, const ChannelData& data) {
  const std::size_t each = draws.grid().size();
  const std::size_t all = each * static_cast<std::size_t>(draws.sampler().lobes());
  const auto total = static_cast<double>(data.moments.count);
  Counts counts{std::vector<double>(each), std::vector<double>(each)};
  for (std::size_t i = 0; i < all; ++i) {
    counts.observed[i % each] += static_cast<double>(data.cells[i]);
    counts.expected[i % each] += total * draws.cells().grid.probability[i];
  }
  return counts;
}

/// A draw where none is expected is beyond any scale.
double residual(double observed, double expected) {
  if (expected > 0) return (observed - expected) / std::sqrt(expected);
  return observed > 0 ? std::numeric_limits<double>::infinity() : 0;
}

}  // namespace

void add_cells(const TestWork& work, reports::Test& test) {
  const TestOutcome& outcome = work.outcome;
  if (outcome.channels.empty() || outcome.question.kind != QuestionKind::fit_to_density ||
      outcome.plan.method.keeps != Keeps::cells) {
    return;
  }
  const auto* draws = dynamic_cast<const SamplerSetup*>(outcome.question.subjects[0].setup.get());
  if (draws == nullptr || draws->sampler().domain() == Domain::interval) return;
  const std::vector<ChannelData> data = data_of(work, outcome.channels[0].index);
  const Counts counts = counts_of(*draws, data[0]);
  const std::string axes = axes_of(*draws);
  const auto add = [&](const char* name, auto value) {
    reports::Map map{.name = name,
                     .source = axes,
                     .file = "",
                     .width = draws->grid().y_borders.size() - 1,
                     .height = draws->grid().x_borders.size() - 1,
                     .components = {"draws"},
                     .texels = {}};
    for (std::size_t i = 0; i < counts.observed.size(); ++i) {
      map.texels.values.push_back(static_cast<float>(value(i)));
    }
    test.maps.push_back(std::move(map));
  };
  add("cells_observed", [&](std::size_t i) { return counts.observed[i]; });
  add("cells_expected", [&](std::size_t i) { return counts.expected[i]; });
  add("cells_z", [&](std::size_t i) { return residual(counts.observed[i], counts.expected[i]); });
}

}  // namespace assay::harness
