#include "harness/image/image_evidence.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "estimators/stream.h"
#include "harness/base/work.h"
#include "harness/theta/theta.h"
#include "stats/basics/moments.h"
#include "stats/gates/assumption_gates.h"
#include "stats/images/image_equivalence.h"
#include "stats/images/image_law.h"
#include "stats/pyramids/image_pyramid.h"
#include "stats/tails/tails.h"

namespace assay::harness {
namespace {

stats::ImageDistance in_units_of_margin(const stats::ImageDistance& distance,
                                        const stats::ImageExtent& extent, bool relative) {
  if (!relative) {
    return stats::relative_to(distance, {.squared_bias = static_cast<double>(extent.elements())});
  }
  if (!(distance.squared_norm > 0)) {
    throw std::domain_error(
        "the reference image is zero within its noise, so per cent of it have no meaning; give "
        "`detect` or `within` as a number, in the image's unit");
  }
  return distance;
}

stats::ImageDistance distance_of(const Question& question, const ImagePair& pair) {
  const stats::ImageDistance distance = stats::image_distance(pair.pair(), on_all_threads);
  if (pair.subtracted) {
    // All `value`s of a pair are 0.
    return stats::relative_to(
        distance, stats::image_distance({*pair.subtracted, pair.reference()}, on_all_threads));
  }
  const bool independent = std::ranges::all_of(
      question.subjects, [](const Subject& side) { return side.image->independent; });
  return stats::with_reference_error(
      distance, pair.pair(),
      independent ? stats::ElementErrors::independent : stats::ElementErrors::unknown);
}

/// Standard errors of what this look finds.
void note_errors(const std::vector<stats::ChannelMeans>& means, bool relative, double alpha,
                 double beta, ImageOutcome& outcome) {
  const stats::TypicalCell& typical = outcome.family.typical;
  const double part = typical.group.share / typical.group.count;
  const double errors =
      stats::upper_normal_quantile(alpha * part / 2) + stats::upper_normal_quantile(beta);
  const std::vector<double> of_cells = mapped(
      typical.noise, [&](const auto& noise) { return stats::standard_error_at(noise, errors); });
  outcome.uniform_error = least_error(uniform_errors(means[0], means[1]), means[1], relative);
  outcome.cell_error = least_error(of_cells, means[1], relative);
}

stats::ChannelMeans means_held_against(const ImagePair& pair) {
  if (!pair.subtracted)
    return pair.second ? stats::channel_means(*pair.second, on_all_threads)
                       : stats::channel_means(pair.reference());
  stats::ChannelMeans means = stats::channel_means(*pair.subtracted, on_all_threads);
  drop_errors(means);
  return means;
}

/// Pictures of files that are alike and were not refused have no noise, such as a layer of depth.
/// What is drawn should vary.
void require_spread(const Question& question, bool varies) {
  if (varies || std::ranges::all_of(question.subjects, is_recorded)) return;
  const auto name_of = [](const Subject& subject) { return subject.estimator->name; };
  throw stats::ZeroVariance(fmt::format(
      "the images of {} never vary: values without spread say nothing about unseen values; check "
      "that the seed changes the image, take fewer `primaries`, or more observations",
      quoted(mapped(question.subjects, name_of))));
}

bool varies(const stats::ImageStack& stack) {
  return std::ranges::any_of(
      stack.images, [&](const auto& image) { return !std::ranges::equal(image, stack.images[0]); });
}

void require_independent(const ImageTest& test, const ImagePair& pair) {
  if (!test.require_independent) return;
  test.require_independent(stats::image_dependence(pair.pair(), on_all_threads));
}

PictureLook look_at(const Question& question, const ImageTest& test, ImagePair pair) {
  const auto [fewest, most] = pair.replicates();
  stats::check::replicates("image", fewest);
  require_independent(test, pair);
  PictureLook look{.pictures = most};
  look.distance = distance_of(question, pair);
  look.means = {stats::channel_means(pair.first, on_all_threads), means_held_against(pair)};
  look.z.resize(pair.first.extent.elements());
  const bool of_two = pair.second.has_value();
  stats::ImageConstants constants = pair.settle(question);
  const bool has_noise = constants.count < pair.first.extent.elements() ||
                         (pair.subtracted && varies(*pair.subtracted));
  require_spread(question, has_noise);
  // Beside noise, an element that never varied may have missed rare values.
  const stats::PyramidOptions options{
      .z = look.z,
      .for_each = on_all_threads,
      .constants_decide = of_two || question.is().of_pairs || !has_noise,
      .unseen = std::move(constants.unseen)};
  look.family = stats::image_pyramid(pair.pair(), options);
  for (const stats::UnseenElement& each : look.family.unseen) look.z[each.element] = each.z();
  return look;
}

/// Pictures that were looked at while reading declare neither rounding nor range. So an element of
/// them that never varied stays as it is.
PictureLook look_of(const Seen& seen, const ImageTest& test) {
  if (test.look == nullptr) return look_at(seen.question, test, ImagePair(seen));
  if (test.require_independent) test.require_independent(test.look->dependence);
  return *test.look;
}

/// "x 8-15".
std::string range_text(char axis, std::int64_t first, std::uint32_t count) {
  if (count == 1) return fmt::format("{} {}", axis, first);
  return fmt::format("{} {}-{}", axis, first, first + count - 1);
}

std::string seen_text(const stats::ImageLawFinding& most, const std::string& side) {
  const auto text = [&](const char* what) {
    return fmt::format("the {} {} in {}", what, most.z > 0 ? "larger" : "smaller", side);
  };
  switch (most.score) {
    case stats::ImageScore::value:
      return text("mean is");
    case stats::ImageScore::rank:
      return text("values are mostly");
    case stats::ImageScore::spread:
      return text("spread of the values is");
    case stats::ImageScore::largest:
      break;
  }
  return text("brightest values are mostly");
}

void until_interrupted(std::size_t count, const std::function<void(std::size_t)>& work) {
  on_all_threads(count, [&](std::size_t i) {
    if (!interrupted()) work(i);
  });
  stop_if_interrupted();
}

stats::ImageLawTest law_test_of(const Question& question, const ImageTest& test,
                                const ImagePair& pair) {
  require_independent(test, pair);
  require_spread(question, varies(pair.first) || varies(*pair.second));
  return stats::image_law_test(
      pair.first, *pair.second,
      {.permutations = stats::permutations_at(test.share.alpha),
       .draw =
           [key = test.labels](std::uint64_t index, std::size_t count, std::size_t size) {
             Stream stream(key, index);
             return stats::drawn_subset([&] { return stream.uniform(); }, count, size);
           },
       .for_each = until_interrupted});
}

using stats::Declarations;

/// Pictures of files share one.
Declarations declared_by(const Subject& subject) {
  if (subject.setup->pictures()) return {{Channel().low, Channel().high, Channel().rounding}};
  const double precision = relative_rounding(*subject.setup);
  return mapped(subject.declared(), [&](const Channel& channel) {
    return stats::DeclaredValues{channel.low, channel.high, channel.rounding, precision};
  });
}

/// The second side's declarations of factor x + offset.
Declarations mapped_by(const Question& question) {
  Declarations all = declared_by(question.subjects[1]);
  for (stats::DeclaredValues& each : all) {
    const double low = question.mapped(each.low);
    const double high = question.mapped(each.high);
    each.low = std::min(low, high);
    each.high = std::max(low, high);
    each.rounding *= std::abs(question.factor);
    each.offset = question.offset;
  }
  return all;
}

}  // namespace

ChannelEvidence evidence_of_image_laws(const Seen& seen, const ImageTest& test) {
  const Question& question = seen.question;
  ImageOutcome outcome;
  const ImagePair pair(seen);
  outcome.replicates = pair.replicates().second;
  stats::ImageLawTest law = law_test_of(question, test, pair);
  const stats::ImageExtent extent = extent_of(*question.subjects[0].image);
  stats::ImageFinding most{.size = law.most.window.width,
                           .window = law.most.window,
                           .channel = law.most.channel,
                           .z = law.most.z,
                           .log_p = law.log_p,
                           .adjusted_log_p = law.log_p};
  outcome.family = {
      .log_p = law.log_p, .winner = most, .groups = {most}, .tested = extent.elements()};
  outcome.seen = seen_text(law.most, question.subjects[0].estimator->name);
  outcome.z = std::move(law.z);
  return {stats::law_evidence(law), std::move(outcome)};
}

double share_of_distance(const Question& question) {
  const bool is_picture =
      !question.of_two() && std::holds_alternative<ScaledQuantity>(question.test->claim.right);
  return is_picture ? 0 : stats::share_of_distance;
}

PlaceText place_text(const stats::ImageFinding& finding, const ImageShape& shape,
                     std::span<const float> weights) {
  const stats::Rectangle& window = finding.window;
  const std::size_t pixels = window.area();
  const bool whole = pixels > 1 && pixels == shape.pixels();
  PlaceText text{.place = whole ? "the whole image"
                                : range_text('x', shape.left + window.x, window.width) + ", " +
                                      range_text('y', shape.top + window.y, window.height)};
  if (shape.components.size() > 1) text.place += " of " + shape.components[finding.channel];
  // A constant difference has neither weights nor a z.
  const bool varies = std::isfinite(finding.z);
  const auto has_weight = [&](std::size_t element) { return weights[element] > 0; };
  const bool has_error = finding.effect.standard_error > 0;
  const auto varying = weights.empty() || !has_error
                           ? pixels
                           : static_cast<std::size_t>(
                                 std::ranges::count_if(elements_of(finding, shape), has_weight));
  if (finding.alternation) {
    constexpr const char* patterns[] = {"columns in turn", "rows in turn", "a checkerboard"};
    text.place += fmt::format(" with alternating signs ({})",
                              patterns[static_cast<int>(*finding.alternation)]);
  } else if (pixels == 1) {
    text.place = "pixel " + text.place;
  } else if (2 * varying < pixels) {
    text.place = "what varies in " + text.place;
    text.size = fmt::format(" ({} of {} pixels)", varying, pixels);
  } else if (!whole) {
    text.size = fmt::format(" ({} x {} pixels)", window.width, window.height);
  }
  if (varies) text.size += fmt::format(", z = {:+.3g}", finding.z);
  return text;
}

std::vector<std::size_t> elements_of(const stats::ImageFinding& finding, const ImageShape& shape) {
  std::vector<std::size_t> elements;
  const stats::Rectangle& window = finding.window;
  for (std::size_t y = window.y; y < window.y + window.height; ++y) {
    for (std::size_t x = window.x; x < window.x + window.width; ++x) {
      elements.push_back((y * shape.width + x) * shape.components.size() + finding.channel);
    }
  }
  return elements;
}

ChannelEvidence evidence_of_images(const Seen& seen, const ImageTest& test) {
  const Question& question = seen.question;
  const bool relative = question.theta->is_relative(question, 0);
  const stats::ImageExtent extent = extent_of(*question.subjects[0].image);
  ImageOutcome outcome;
  PictureLook look = look_of(seen, test);
  const stats::ImageDistance distance = in_units_of_margin(look.distance, extent, relative);
  outcome.replicates = look.pictures;
  outcome.family = std::move(look.family);
  outcome.z = std::move(look.z);
  const double share = share_of_distance(question);
  stats::leave_share(outcome.family, share);
  stats::decide(outcome.family);
  note_errors(look.means, relative, (1 - share) * test.share.alpha, test.share.beta, outcome);
  const stats::ImageFamily& family = outcome.family;
  // Differences of pairs are held against 0.
  const stats::ChannelMeans other =
      question.is().of_pairs ? stats::ChannelMeans(look.means[1].size()) : look.means[1];
  const stats::ThetaOfImages images{
      .of_elements = distance,
      .hidden = std::sqrt(family.hidden_squares / distance.squared_norm),
      .hidden_of_twice = std::sqrt(family.hidden_squares_of_twice / distance.squared_norm),
      .of_means = stats::distances_of_means(look.means[0], other, extent, distance.squared_norm),
      .share = share};
  const TestEntry& entry = *question.test;
  const bool within = entry.claim.relation == Relation::within;
  if (within || entry.detect) {
    const double margin = within ? entry.claim.margin.value : entry.detect->value;
    outcome.wanted = stats::deciding_replicates(images, margin, test.share.beta,
                                                static_cast<double>(outcome.replicates));
  }
  Evidence evidence =
      stats::image_evidence(images,
                            {.statistic = family.winner.z,
                             .distribution = {"image-family", {static_cast<double>(family.tested)}},
                             .log_p_lower = 0,
                             .log_p_upper = family.log_p},
                            test.share.alpha);
  evidence.relative = relative;
  evidence.quantity = relative ? "relative root mean square difference of the images"
                               : "root mean square difference of the images";
  return {std::move(evidence), std::move(outcome)};
}

stats::ImageExtent extent_of(const ImageShape& shape) {
  return {.width = shape.width, .height = shape.height, .channels = shape.components.size()};
}

ImagePair::ImagePair(const Seen& seen) {
  const Question& question = seen.question;
  const stats::ImageExtent extent = extent_of(*question.subjects[0].image);
  first = {extent, seen.data[0].images.images()};
  if (question.of_two()) {
    const bool maps = question.factor != 1 || question.offset != 0;
    const ImageViews& other = seen.data[1].images;
    const auto moved = [&](float texel) { return static_cast<float>(question.mapped(texel)); };
    const auto to_first = [&](const auto& image) { return mapped(image, moved); };
    if (maps) scaled_ = ImageViews(mapped(other.images(), to_first));
    second = {extent, (maps ? scaled_ : other).images()};
    if (!question.is().of_pairs) return;
    subtracted.swap(second);
    first = stats::difference(first, *subtracted, differences_, on_all_threads);
    value.assign(extent.elements(), 0);
    return;
  }
  value = mapped(question.references,
                 [&](const Constant& reference) { return reference.value + question.offset; });
  const bool exact = std::ranges::all_of(
      question.references, [](const Constant& each) { return each.standard_error == 0; });
  if (exact) return;
  error = mapped(question.references, &Constant::standard_error);
}

stats::ImageConstants ImagePair::settle(const Question& question) {
  Declarations declared = declared_by(question.subjects[0]);
  if (second) {
    return stats::settle_constants({first, std::move(declared)}, {*second, mapped_by(question)},
                                   settled_);
  }
  if (subtracted) {
    declared =
        stats::of_differences(std::move(declared), mapped_by(question), subtracted->images[0]);
  }
  return stats::settle_constants({first, std::move(declared)}, value, error, question.is().of_pairs,
                                 settled_);
}

}  // namespace assay::harness
