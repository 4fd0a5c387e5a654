#include "harness/record/image_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "estimators/map_file.h"
#include "estimators/ready_made.h"
#include "harness/base/numbers.h"
#include "harness/base/parallel.h"
#include "harness/base/text_hash.h"
#include "harness/question/question_sources.h"
#include "harness/run/image_judge.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

using reports::Number;

const char* statistic_name(stats::ImageStatistic statistic) {
  return statistic == stats::ImageStatistic::alternating ? "alternating" : "window";
}

reports::ImageFinding finding_of(const stats::ImageFinding& finding, const ImageShape& shape) {
  return {.statistic = statistic_name(finding.statistic),
          .place = place_text(finding, shape),
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
                       .constant = family.equal_constants - outcome.unseen.size(),
                       .unseen = outcome.unseen.size()};
  if (family.groups.empty()) return image;
  image.winner = finding_of(family.winner, shape);
  for (const stats::ImageFinding& group : family.groups) {
    image.groups.push_back(finding_of(group, shape));
  }
  return image;
}

float narrow(double value) {
  constexpr double most = std::numeric_limits<float>::max();
  return std::isfinite(value) ? static_cast<float>(std::clamp(value, -most, most))
                              : static_cast<float>(value);
}

/// A map of value(element).
template <class Value>
reports::Map map_of(const char* name, const ImageShape& shape, const Value& value) {
  constexpr std::size_t at_a_time = std::size_t{1} << 16;
  reports::Map map{
      .name = name, .width = shape.width, .height = shape.height, .components = shape.components};
  std::vector<float>& texels = map.texels.values;
  texels.resize(shape.elements());
  on_all_threads((texels.size() + at_a_time - 1) / at_a_time, [&](std::size_t part) {
    const std::size_t first = part * at_a_time;
    const std::size_t last = std::min(first + at_a_time, texels.size());
    for (std::size_t i = first; i < last; ++i) texels[i] = narrow(value(i));
  });
  return map;
}

/// |z| up to which an element's adjusted p is 1 - e^-40 or more, so that its tail need not be
/// computed.
double surely_one(double tested) {
  const double tail = 20 / tested;  // two-sided
  return tail < 0.25 ? stats::normal_quantile({stats::Tail::upper, std::log(tail)}) : 0;
}

/// Sidak's adjustment over the elements that vary.
double adjusted_p(double z, double tested) {
  const double log_p = std::isfinite(z)
                           ? std::min(0.0, std::log(2.0) + stats::normal_tails(std::abs(z)).upper)
                           : std::numeric_limits<double>::lowest();
  return std::exp(stats::adjusted(log_p, {.count = tested, .share = 1}));
}

reports::Map adjusted_map(const ImageShape& shape, const std::vector<double>& z, double tested) {
  const double one = surely_one(tested);
  return map_of("p_adjusted", shape,
                [&](std::size_t i) { return std::abs(z[i]) < one ? 1 : adjusted_p(z[i], tested); });
}

void add_moments(const DrawnTest& drawn, std::size_t subject, reports::Test& test) {
  const Subject& side = drawn.outcome.question.subjects[subject];
  const Summary& summary = drawn.samples[subject].summary();
  const auto moments = [&](std::size_t i) { return summary.moments(side.channels[i]); };
  const char* const mean_names[] = {"mean", "other_mean"};
  const char* const variance_names[] = {"variance", "other_variance"};
  test.maps.push_back(
      map_of(mean_names[subject], *side.image, [&](std::size_t i) { return moments(i).mean; }));
  test.maps.back().source = side.estimator->listed;
  test.maps.push_back(map_of(variance_names[subject], *side.image,
                             [&](std::size_t i) { return moments(i).variance(); }));
  test.maps.back().source = side.estimator->listed;
}

void add_maps(const DrawnTest& drawn, const ImageOutcome& outcome, reports::Test& test) {
  const Question& question = drawn.outcome.question;
  const ImageShape& shape = *question.subjects[0].image;
  const double tested = std::max(1.0, static_cast<double>(outcome.family.tested));
  test.maps.push_back(map_of("z", shape, [&](std::size_t i) { return outcome.z[i]; }));
  test.maps.push_back(adjusted_map(shape, outcome.z, tested));
  for (std::size_t subject = 0; subject < question.subjects.size(); ++subject) {
    add_moments(drawn, subject, test);
  }
  if (question.of_two()) return;
  test.maps.push_back(map_of("reference", shape, [&](std::size_t i) {
    return question.references[i].value + question.offset;
  }));
}

/// A unique file name of letters, digits, `-` and `_` for each test.
std::string file_name(const std::string& id) {
  constexpr std::size_t longest = 80;
  std::string name;
  for (const char c : id.substr(0, longest)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (plain || c == '-') {
      name += c;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  return fmt::format("{}-{:08x}.exr", name, text_hash(id) & 0xffffffff);
}

Extremes extremes_of(const Summary& summary, const std::vector<std::size_t>& channels) {
  if (summary.elements) {
    return summary.elements->extremes;
  }
  Extremes extremes;
  for (const std::size_t channel : channels) {
    const ChannelSummary& kept = summary.channels[channel];
    extremes.nonzero += kept.moments.nonzero;
    if (kept.moments.count >= 2) extremes.merge({kept.moments.minimum, kept.moments.maximum, 0});
  }
  return extremes;
}

/// The mean over an image whose pixels are independent. A pixel's components may depend on each
/// other: the standard deviation of their sum is at most the sum of theirs. The interval can thus
/// be too wide, not too narrow. Degrees of freedom by Satterthwaite (1946).
reports::Estimate image_mean(const ImageShape& shape, const Summary& summary, double mean,
                             double confidence) {
  reports::Estimate estimate{number(mean), {}, {}};
  const std::uint64_t count = summary.moments(0).count;
  if (!shape.independent || count < 2) return estimate;
  double sum = 0;
  double squares = 0;
  for (std::size_t pixel = 0; pixel < shape.pixels(); ++pixel) {
    double deviation = 0;
    for (std::size_t c = 0; c < shape.components.size(); ++c) {
      const std::size_t element = pixel * shape.components.size() + c;
      const stats::Moments moments = summary.moments(element);
      if (moments.count < 2) return estimate;
      deviation += std::sqrt(moments.variance());
    }
    sum += deviation * deviation;
    squares += std::pow(deviation, 4);
  }
  if (!(sum > 0) || !std::isfinite(squares) || !(squares > 0)) return estimate;
  const double degrees = sum * sum / squares * static_cast<double>(count - 1);
  const double error =
      std::sqrt(sum / static_cast<double>(count)) / static_cast<double>(shape.elements());
  const double half = error * stats::student_t_quantile(
                                  {stats::Tail::upper, std::log((1 - confidence) / 2)}, degrees);
  estimate.low = number(mean - half);
  estimate.high = number(mean + half);
  return estimate;
}

}  // namespace

void add_elements(const Subject& side, const Summary& summary, reports::Sample& sample) {
  const Extremes extremes = extremes_of(summary, side.channels);
  sample.nonzero = extremes.nonzero;
  stats::Moments means;
  double variance = 0;
  for (const std::size_t channel : side.channels) {
    if (!summary.elements) sample.nonfinite += summary.channels[channel].nonfinite;
    const stats::Moments moments = summary.moments(channel);
    if (moments.count < 2) continue;
    means.add(moments.mean);
    variance += moments.variance();
  }
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
                        .confidence = confidence_at_place,
                        .relative = relative};
  }
  add_maps(drawn, found, test);
}

reports::EstimatorChannel image_channel(const Setup& setup, const Summary& summary,
                                        ImagePicture picture) {
  const ImageShape shape = *setup.image();
  const bool unknown = recorded::unknown_channels(setup).has_value();
  const std::vector<Channel> channels = unknown ? std::vector<Channel>() : setup.channels();
  const double elements = static_cast<double>(shape.elements());
  double mean = 0;
  double variance = 0;
  double reference = 0;
  bool known = !unknown;
  for (std::size_t i = 0; i < shape.elements(); ++i) {
    const stats::Moments moments = summary.moments(i);
    mean += moments.mean / elements;
    if (moments.count > 1) variance += picture.averaged * moments.variance() / elements;
    known = known && channels[i].mean.has_value();
    if (known) reference += *channels[i].mean / elements;
  }
  reports::EstimatorChannel row{.name = image_name(shape),
                                .mean = image_mean(shape, summary, mean, picture.confidence),
                                .variance = {number(variance), {}, {}}};
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
        // Close-ups of cells are kept in the record alone.
        if (map.width != size.width || map.height != size.height) continue;
        map.file = (folder.filename() / name).string();
        layers.push_back({map.name, map.components, map.texels.values});
      }
      write_map_file((folder / name).string(), size, layers);
    }
  }
}

}  // namespace assay::harness
