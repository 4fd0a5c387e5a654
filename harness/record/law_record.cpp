#include "harness/record/law_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <optional>

#include "harness/draws/declared_density.h"
#include "harness/draws/sampler_setup.h"
#include "harness/families/law_evidence.h"
#include "stats/cells/chi_square_fit.h"
#include "stats/laws/simultaneous_error.h"
#include "stats/means/binomial.h"

namespace assay::harness {
namespace {

struct Cells {
  std::string axes;
  std::size_t width = 0, height = 0;
  std::vector<double> observed = {}, expected = {};
  std::vector<double> z = {};
  std::string of_z = "";  ///< a remark on z
  std::optional<CloseUp> close = {};
};

/// (observed - expected) in standard deviations; the count's variance is `variance` * expected.
/// Infinite for a draw where none is expected.
double residual(double observed, double expected, double variance = 1) {
  const double difference = observed - expected;
  if (expected > 0) return difference / std::sqrt(expected * variance);
  return difference > 0 ? std::numeric_limits<double>::infinity() : 0;
}

std::string axis(const Marginal& marginal, const std::vector<double>& borders) {
  return fmt::format("{} {:.4g} to {:.4g}", marginal.name, borders.front(), borders.back());
}

/// Names the coordinates of cells of equal measure.
std::string axes_of(const SamplerSetup& draws, const stats::PlaneGrid& grid) {
  const std::vector<Marginal> coordinates = cell_coordinates(draws.sampler());
  return fmt::format("{} from top to bottom, {} from left to right",
                     axis(coordinates[0], grid.x_borders), axis(coordinates[1], grid.y_borders));
}

/// True if some grid cells hold several counted ones: parts, or lobes.
bool are_divided(const DensityCells& density, const stats::PlaneGrid& grid) {
  return density.cells.in_domain() > grid.size();
}

// The fewest expected draws for a residual. It shows places before they suffice for a test.
constexpr double least_shown = 5;

/// The residual of each cell in the domain that expects enough draws.
std::vector<std::optional<double>> residuals_of(const DensityCells& density,
                                                const ChannelData& data, double least) {
  const auto total = static_cast<double>(data.moments.count);
  const std::vector<std::uint64_t> counts = density.in_cells(data.cells);
  std::vector<std::optional<double>> residuals;
  for (std::size_t i = 0; i < density.cells.in_domain(); ++i) {
    const double expected = total * density.mass.probability[i];
    const auto observed = static_cast<double>(counts[i]);
    residuals.push_back(expected >= least ? std::optional(residual(observed, expected))
                                          : std::nullopt);
  }
  return residuals;
}

/// Counts in the grid's cells, summed over lobes and parts of halved cells. The residual is the
/// largest of the parts that are tested alone, else that of the sum.
Cells of_density(const SamplerSetup& draws, const ChannelData& data) {
  const DensityCells& density = draws.density_cells();
  const stats::PlaneGrid& grid = density.cells.grid();
  const auto total = static_cast<double>(data.moments.count);
  Cells cells{.axes = axes_of(draws, grid),
              .width = grid.columns(),
              .height = grid.rows(),
              .observed = std::vector<double>(grid.size()),
              .expected = std::vector<double>(grid.size())};
  // Residuals of cells that are tested alone.
  const std::vector<std::optional<double>> tested =
      residuals_of(density, data, stats::FitOptions{}.minimum_expected);
  std::vector<std::optional<double>> farthest(grid.size());
  const std::vector<std::uint64_t> counts = density.in_cells(data.cells);
  for (std::size_t i = 0; i < density.cells.in_domain(); ++i) {
    const std::size_t place = density.cells.grid_cell(i);
    cells.observed[place] += static_cast<double>(counts[i]);
    cells.expected[place] += total * density.mass.probability[i];
    if (std::abs(tested[i].value_or(0)) > std::abs(farthest[place].value_or(0))) {
      farthest[place] = tested[i];
    }
  }
  for (std::size_t i = 0; i < grid.size(); ++i) {
    cells.z.push_back(farthest[i].value_or(residual(cells.observed[i], cells.expected[i])));
  }
  if (are_divided(density, grid)) {
    cells.of_z = "; of the parts of a cell the one that is farthest off";
    cells.close = close_up(density, draws.sampler(), residuals_of(density, data, least_shown));
  }
  return cells;
}

bool are_a_rectangle(const stats::SampledCells& cells) {
  const std::size_t cuts = cells.cut_borders.front().size();
  return cuts > 0 && std::all_of(cells.cut_borders.begin(), cells.cut_borders.end(),
                                 [&](const auto& borders) { return borders.size() == cuts; });
}

/// The first sample, against its part of both together.
Cells of_two(const Question& question, const stats::SampledCells& sampled,
             std::span<const ChannelData> data) {
  const Subject& first = question.subjects[0];
  const std::vector<Channel> channels = first.setup->channels();
  const std::vector<std::uint64_t> x = counts_in(sampled, first, data[0]);
  const std::vector<std::uint64_t> y = counts_in(sampled, question.subjects[1], data[1]);
  const auto n = static_cast<double>(data[0].all_values[0].size());
  const auto m = static_cast<double>(data[1].all_values[0].size());
  Cells cells{.axes = fmt::format("of {}, parts of equal probability: of {} from top to bottom, of "
                                  "{} within each from left to right; expected as of both samples",
                                  first.estimator->listed, channels[first.channels[0]].name,
                                  channels[first.channels[1]].name),
              .width = sampled.cut_borders.front().size() + 1,
              .height = sampled.cut_borders.size()};
  for (std::size_t i = 0; i < sampled.size(); ++i) {
    cells.observed.push_back(static_cast<double>(x[i]));
    cells.expected.push_back(static_cast<double>(x[i] + y[i]) * n / (n + m));
    cells.z.push_back(residual(cells.observed[i], cells.expected[i], m / (n + m)));
  }
  return cells;
}

Cells cells_of(const DrawnTest& test) {
  const TestOutcome& outcome = test.outcome;
  const Question& question = outcome.question;
  const std::vector<ChannelData> data = data_of(test, outcome.channels[0].index);
  if (question.is().of_a_law && outcome.plan.method.keeps == Keeps::cells) {
    const auto& draws = dynamic_cast<const SamplerSetup&>(*question.subjects[0].setup);
    if (draws.sampler().domain() != Domain::interval) return of_density(draws, data[0]);
  }
  const auto& sampled = outcome.plan.method.frozen.cells;
  const bool plane = question.subjects[0].channels.size() > 1;
  if (plane && sampled && are_a_rectangle(*sampled)) {
    return of_two(question, *sampled, data);
  }
  return {};
}

constexpr std::size_t curve_parts = 64;

/// Cached: it takes tenths of a second, and tests of one suite ask for the same values.
double pointwise_error(std::uint64_t n, double confidence) {
  static std::mutex once;
  static std::map<std::pair<std::uint64_t, double>, double> known;
  constexpr std::uint64_t limit_from = 1001;  // the value is constant from there on
                                              // (simultaneous_error.h)
  const std::scoped_lock lock(once);
  const auto [place, added] = known.try_emplace({std::min(n, limit_from), confidence});
  if (added) place->second = stats::simultaneous_error(n, curve_parts, confidence);
  return place->second;
}

reports::EmpiricalLaw empirical_law(const Points& points, double confidence,
                                    const std::optional<DeclaredLaw>& law) {
  reports::EmpiricalLaw drawn{.confidence = confidence};
  const std::vector<double>& sorted = points.sorted;
  const std::uint64_t n = sorted.size();
  // An error below a double's resolution of 1 has no band.
  if (n < 2 || !(confidence < 1)) return drawn;
  const double gamma = pointwise_error(n, confidence);
  std::uint64_t before = 0;
  for (std::size_t i = 1; i < curve_parts; ++i) {
    const std::uint64_t rank = i * n / curve_parts;
    if (rank <= before) continue;
    const double value = sorted[rank - 1];
    // The end of a group of equal values.
    const auto end = std::upper_bound(sorted.begin(), sorted.end(), value);
    before = static_cast<std::uint64_t>(end - sorted.begin());
    const stats::Interval band = stats::clopper_pearson({before, n}, 1 - gamma);
    drawn.points.push_back({.value = value,
                            .observed = static_cast<double>(before) / static_cast<double>(n),
                            .low = band.low,
                            .high = band.high});
    if (law) drawn.points.back().law = law->law.cdf(value);
  }
  return drawn;
}

bool is_drawn(const TestOutcome& outcome) {
  return outcome.question.is().of_a_law && outcome.plan.method.keeps == Keeps::values;
}

}  // namespace

void add_cells(const DrawnTest& drawn, reports::Test& test) {
  if (drawn.outcome.channels.empty()) return;
  const Cells cells = cells_of(drawn);
  if (cells.observed.empty()) return;
  const auto add = [&](const char* name, const std::string& axes, std::size_t width,
                       std::span<const double> values) {
    reports::Map map{.name = name,
                     .source = axes,
                     .width = width,
                     .height = values.size() / width,
                     .components = {"draws"}};
    for (const double value : values) map.texels.values.push_back(static_cast<float>(value));
    test.maps.push_back(std::move(map));
  };
  add("cells_observed", cells.axes, cells.width, cells.observed);
  add("cells_expected", cells.axes, cells.width, cells.expected);
  add("cells_z", cells.axes + cells.of_z, cells.width, cells.z);
  if (cells.close) add("cells_z_close", cells.close->axes, cells.close->side, cells.close->z);
}

std::vector<reports::EmpiricalLaw> empirical_laws(const DrawnTest& test, std::size_t channel) {
  std::vector<reports::EmpiricalLaw> laws;
  const Question& question = test.outcome.question;
  if (!is_drawn(test.outcome)) return laws;
  std::optional<DeclaredLaw> law;
  if (!question.of_two()) law = declared_law(question, channel);
  const double confidence = 1 - test.outcome.share().alpha;
  const std::vector<ChannelData> data = data_of(test, channel);
  for (std::size_t subject = 0; subject < data.size(); ++subject) {
    laws.push_back(empirical_law(points_of(question, subject, channel, data[subject].values),
                                 confidence, law));
    laws.back().source = question.subjects[subject].estimator->listed;
  }
  return laws;
}

}  // namespace assay::harness
