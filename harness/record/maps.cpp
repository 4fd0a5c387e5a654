#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <regex>

#include "estimators/map_file.h"
#include "harness/base/identity.h"
#include "harness/base/numbers.h"
#include "harness/draws/draw_cells.h"
#include "harness/draws/sampler_setup.h"
#include "harness/families/families.h"
#include "harness/record/record_of.h"
#include "stats/cells/chi_square.h"
#include "stats/images/image_moments.h"
#include "stats/tails/kolmogorov.h"

namespace assay::harness {
namespace {

reports::ImageFinding finding_of(const stats::ImageFinding& finding, const ImageShape& shape,
                                 std::span<const float> weights) {
  return {.statistic = finding.alternation ? "alternating" : "window",
          .place = place_text(finding, shape, weights).place,
          .x = finding.window.x,
          .y = finding.window.y,
          .width = finding.window.width,
          .height = finding.window.height,
          .component = shape.components[finding.channel],
          .z = number(finding.z),
          .log10_p = log10_of(finding.log_p),
          .log10_p_adjusted = log10_of(finding.adjusted_log_p)};
}

reports::Image image_of(const ImageOutcome& outcome, const ImageShape& shape) {
  const stats::ImageFamily& family = outcome.family;
  reports::Image image{.width = shape.width,
                       .height = shape.height,
                       .components = shape.components,
                       .replicates = outcome.replicates,
                       .tested = family.tested,
                       .constant = family.equal_constants,
                       .unseen = family.unseen.size()};
  if (family.groups.empty()) return image;
  image.winner = finding_of(family.winner, shape, family.weights);
  for (const stats::ImageFinding& group : family.groups) {
    image.groups.push_back(finding_of(group, shape, family.weights));
  }
  return image;
}

float narrow(double value) {
  constexpr double most = std::numeric_limits<float>::max();
  return std::isfinite(value) ? static_cast<float>(std::clamp(value, -most, most))
                              : static_cast<float>(value);
}

template <class Value>
reports::Map map_of(const char* name, const ImageShape& shape, const Value& value) {
  return {.name = name,
          .width = shape.width,
          .height = shape.height,
          .components = shape.components,
          .texels = {
              mapped_indices(shape.elements(), [&](std::size_t i) { return narrow(value(i)); })}};
}

void add_maps(const DrawnTest& drawn, const ImageOutcome& outcome, reports::Test& test) {
  const Question& question = drawn.outcome.question;
  const ImageShape& shape = *question.subjects[0].image;
  test.maps.push_back(map_of("z", shape, [&](std::size_t i) { return outcome.z[i]; }));
  for (std::size_t subject = 0; subject < question.subjects.size(); ++subject) {
    const Subject& side = question.subjects[subject];
    const Summary& summary = drawn.samples[subject].summary();
    const auto moments = [&](std::size_t i) { return summary.moments(side.channels[i]); };
    const auto add = [&](const char* name, const auto& value) {
      test.maps.emplace_back(map_of(name, *side.image, value)).source = side.estimator->listed;
    };
    add(subject == 0 ? "mean" : "other_mean", [&](std::size_t i) { return moments(i).mean; });
    add(subject == 0 ? "variance" : "other_variance",
        [&](std::size_t i) { return moments(i).variance(); });
  }
  if (question.of_two()) return;
  test.maps.push_back(map_of("reference", shape, [&](std::size_t i) {
    return question.references[i].value + question.offset;
  }));
}

/// A unique file name of letters, digits, `-` and `_` for each test.
std::string file_name(const std::string& id) {
  constexpr std::size_t longest = 80;
  const std::string name =
      std::regex_replace(id.substr(0, longest), std::regex("[^A-Za-z0-9-]+"), "_");
  return fmt::format("{}-{:08x}.exr", name, text_hash(id) & 0xffffffff);
}

struct Cells {
  std::string axes;
  std::size_t width = 0, height = 0;
  std::vector<double> observed = {}, expected = {};
  std::vector<double> z = {};
  std::string of_z = "";  ///< a remark on z
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

/// Counts in the grid's cells, summed over lobes and parts of halved cells. The residual is the
/// largest of the parts that are tested alone, else that of the sum.
Cells of_density(const SamplerSetup& draws, const ChannelData& data) {
  const DensityCells& density = draws.density_cells();
  const stats::PlaneGrid& grid = density.cells.grid();
  const auto total = static_cast<double>(data.moments.count);
  const std::vector<Marginal> axes = cell_coordinates(draws.sampler());
  Cells cells{.axes = fmt::format("{} from top to bottom, {} from left to right",
                                  axis(axes[0], grid.x_borders), axis(axes[1], grid.y_borders)),
              .width = grid.columns(),
              .height = grid.rows(),
              .observed = std::vector<double>(grid.size()),
              .expected = std::vector<double>(grid.size())};
  const double least = stats::FitOptions{}.minimum_expected;
  std::vector<std::optional<double>> farthest(grid.size());
  const std::vector<std::uint64_t> counts = density.in_cells(data.cells);
  for (std::size_t i = 0; i < density.cells.in_domain(); ++i) {
    const std::size_t place = density.cells.grid_cell(i);
    const auto observed = static_cast<double>(counts[i]);
    const double expected = total * density.mass.probability[i];
    cells.observed[place] += observed;
    cells.expected[place] += expected;
    if (expected < least) continue;
    const double part = residual(observed, expected);
    if (std::abs(part) > std::abs(farthest[place].value_or(0))) farthest[place] = part;
  }
  for (std::size_t i = 0; i < grid.size(); ++i) {
    cells.z.push_back(farthest[i].value_or(residual(cells.observed[i], cells.expected[i])));
  }
  const bool parts_or_lobes = density.cells.in_domain() > grid.size();
  if (parts_or_lobes) cells.of_z = "; of the parts of a cell the one that is farthest off";
  return cells;
}

bool are_a_rectangle(const stats::SampledCells& cells) {
  const std::size_t cuts = cells.cut_borders.front().size();
  return cuts > 0 && std::ranges::all_of(cells.cut_borders, [&](const auto& borders) {
           return borders.size() == cuts;
         });
}

/// The first sample, against its part of both together.
Cells of_two(const Seen& seen, const stats::SampledCells& sampled) {
  const Subject& first = seen.question.subjects[0];
  const std::vector<std::uint64_t> x = counts_in(sampled, seen, 0);
  const std::vector<std::uint64_t> y = counts_in(sampled, seen, 1);
  const auto n = static_cast<double>(seen.data[0].all_values[0].size());
  const auto m = static_cast<double>(seen.data[1].all_values[0].size());
  Cells cells{
      .axes = fmt::format("of {}, parts of equal probability: of {} from top to bottom, of "
                          "{} within each from left to right; expected as of both samples",
                          first.estimator->listed, first.declared(0).name, first.declared(1).name),
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
  const std::size_t channel = outcome.channels[0].index;
  const std::vector<ChannelData> data = data_of(test, channel);
  if (question.is().of_a_law && outcome.plan.method.keeps == Keeps::cells) {
    const auto& draws = dynamic_cast<const SamplerSetup&>(*question.subjects[0].setup);
    if (draws.sampler().domain() != Domain::interval) return of_density(draws, data[0]);
  }
  const auto& sampled = outcome.plan.cells;
  const bool plane = question.subjects[0].channels.size() > 1;
  if (plane && sampled && are_a_rectangle(*sampled))
    return of_two({question, channel, data}, *sampled);
  return {};
}

constexpr std::size_t curve_parts = 64;

/// The band is Kolmogorov's: it leaves the law where its test refutes it.
reports::EmpiricalLaw empirical_law(const stats::Points& points, double confidence,
                                    const std::optional<stats::DeclaredLaw>& law) {
  reports::EmpiricalLaw drawn{.confidence = confidence};
  const std::vector<double>& sorted = points.sorted;
  const std::uint64_t n = sorted.size();
  // An error below a double's resolution of 1 has no band.
  if (n < 2 || !(confidence < 1)) return drawn;
  const double half_width = stats::kolmogorov_upper_quantile(std::log1p(-confidence), n);
  std::uint64_t before = 0;
  for (std::size_t i = 1; i < curve_parts; ++i) {
    const std::uint64_t rank = i * n / curve_parts;
    if (rank <= before) continue;
    const double value = sorted[rank - 1];
    // The end of a group of equal values.
    const auto end = std::ranges::upper_bound(sorted, value);
    before = static_cast<std::uint64_t>(end - sorted.begin());
    const double observed = static_cast<double>(before) / static_cast<double>(n);
    drawn.points.push_back({.value = value,
                            .observed = observed,
                            .low = std::max(0.0, observed - half_width),
                            .high = std::min(1.0, observed + half_width)});
    if (law) drawn.points.back().law = law->law(value);
  }
  return drawn;
}

}  // namespace

void add_elements(const Subject& side, const Summary& summary, reports::Sample& sample) {
  stats::Extremes extremes = summary.elements ? summary.elements->extremes : stats::Extremes();
  stats::Moments means;
  double variance = 0;
  for (const std::size_t channel : side.channels.all()) {
    const stats::Moments moments = summary.moments(channel);
    if (!summary.elements) {
      sample.nonfinite += summary.channels[channel].nonfinite;
      extremes.nonzero += moments.nonzero;
    }
    if (moments.count < 2) continue;
    extremes.merge({moments.minimum, moments.maximum, 0});
    means.add(moments.mean);
    variance += moments.variance();
  }
  sample.nonzero = extremes.nonzero;
  if (means.count > 0) {
    sample.mean = number(means.mean);
    sample.variance = number(variance / static_cast<double>(means.count));
    sample.min = number(extremes.minimum);
    sample.max = number(extremes.maximum);
  }
}

void add_image(const DrawnTest& drawn, reports::Test& test) {
  const TestOutcome& outcome = drawn.outcome;
  if (outcome.channels.empty() || !outcome.channels[0].image) return;
  const ImageOutcome& found = *outcome.channels[0].image;
  test.image = image_of(found, *outcome.question.subjects[0].image);
  if (!found.seen.empty()) test.image->winner.statistic = found.seen;
  if (const std::optional<PlaceEffect> effect = effect_at_place(drawn)) {
    const bool relative = effect->other != 0;
    const double unit = relative ? std::abs(effect->other) : 1;
    test.image->winner.effect =
        reports::Effect{.quantity = relative ? "relative difference" : "difference",
                        .estimate = number(effect->estimate / unit),
                        .low = number(effect->interval.low / unit),
                        .high = number(effect->interval.high / unit),
                        .confidence = effect->interval.confidence,
                        .relative = relative};
    if (outcome.verdict == reports::Verdict::fail) {
      test.image->winner.others = others_at(drawn, *effect);
    }
  }
  add_maps(drawn, found, test);
}

reports::EstimatorChannel image_channel(const Setup& setup, const Summary& summary, double averaged,
                                        double confidence) {
  const ImageShape shape = *setup.image();
  const double elements = static_cast<double>(shape.elements());
  double mean = 0;
  double variance = 0;
  double reference = 0;
  bool known = true;
  for (std::size_t i = 0; i < shape.elements(); ++i) {
    const stats::Moments moments = summary.moments(i);
    mean += moments.mean / elements;
    if (moments.count > 1) variance += averaged * moments.variance() / elements;
    if (!known) continue;
    const std::optional<double> exact = setup.channel(i).mean;
    known = exact.has_value();
    reference += exact.value_or(0) / elements;
  }
  reports::EstimatorChannel row{.name = image_name(shape),
                                .mean = {number(mean), {}, {}},
                                .variance = {number(variance), {}, {}}};
  const auto moments_of = [&](std::size_t element) { return summary.moments(element); };
  const auto interval =
      shape.independent ? stats::interval_of_mean(extent_of(shape), moments_of, mean, confidence)
                        : std::nullopt;
  if (interval) row.mean = {number(mean), number(interval->low), number(interval->high)};
  if (known) row.reference = number(reference);
  return row;
}

void write_maps(reports::Record& record, const std::string& json_path) {
  const std::filesystem::path path(json_path);
  const std::filesystem::path folder = path.parent_path() / (path.stem().string() + ".maps");
  for (reports::Suite& suite : record.suites) {
    for (reports::Test& test : suite.tests) {
      if (test.maps.empty()) continue;
      std::filesystem::create_directories(folder);
      const std::string name = file_name(test.id);
      const MapSize size{test.maps.front().width, test.maps.front().height};
      std::vector<MapLayer> layers;
      for (reports::Map& map : test.maps) {
        map.file = (folder.filename() / name).string();
        layers.push_back({map.name, map.components, map.texels.values});
      }
      write_map_file((folder / name).string(), size, layers);
    }
  }
}

void add_cells(const DrawnTest& drawn, reports::Test& test) {
  if (drawn.outcome.channels.empty()) return;
  const Cells cells = cells_of(drawn);
  if (cells.observed.empty()) return;
  const ImageShape shape{.width = cells.width, .height = cells.height, .components = {"draws"}};
  const auto add = [&](const char* name, const std::string& axes,
                       const std::vector<double>& values) {
    test.maps.push_back(map_of(name, shape, [&](std::size_t i) { return values[i]; }));
    test.maps.back().source = axes;
  };
  add("cells_observed", cells.axes, cells.observed);
  add("cells_expected", cells.axes, cells.expected);
  add("cells_z", cells.axes + cells.of_z, cells.z);
}

std::vector<reports::EmpiricalLaw> empirical_laws(const DrawnTest& test, std::size_t channel) {
  const Question& question = test.outcome.question;
  if (!question.is().of_a_law || test.outcome.plan.method.keeps != Keeps::values) return {};
  std::optional<stats::DeclaredLaw> law;
  if (!question.of_two()) law = declared_law(question, channel);
  const double confidence = 1 - test.outcome.share().alpha;
  const std::vector<ChannelData> data = data_of(test, channel);
  return mapped_indices(data.size(), [&](std::size_t subject) {
    const stats::Points points = points_of({question, channel, data}, subject);
    reports::EmpiricalLaw drawn = empirical_law(points, confidence, law);
    drawn.source = question.subjects[subject].estimator->listed;
    return drawn;
  });
}

}  // namespace assay::harness
