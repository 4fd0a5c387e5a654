#include "stats/images/image_family.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr double alternating_share = 0.025;
// A cell is as clear as one that holds it from this part of its standard errors on.
constexpr double as_clear = 0.99;
// A cell may tell the place of a finding if its p-value is the root of the finding's, or smaller.
constexpr double as_unlikely = 0.5;

// The effect in standard errors.
double errors_of(const ImageFinding& finding) {
  return std::abs(finding.effect.estimate) / finding.effect.standard_error;
}

bool overlap(const Rectangle& a, const Rectangle& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

bool is_inside(const Rectangle& inner, const Rectangle& outer) {
  return inner.x >= outer.x && inner.y >= outer.y &&
         inner.x + inner.width <= outer.x + outer.width &&
         inner.y + inner.height <= outer.y + outer.height;
}

std::uint32_t narrow(std::size_t value) { return static_cast<std::uint32_t>(value); }

struct Side {
  std::uint32_t start;
  std::uint32_t length;
};

std::vector<Side> aligned_sides(std::uint32_t extent, std::uint32_t size) {
  std::vector<Side> sides;
  for (std::uint32_t x = 0; x < extent; x += size) sides.push_back({x, std::min(size, extent - x)});
  return sides;
}

std::vector<Side> shifted_sides(std::uint32_t extent, std::uint32_t size) {
  const std::uint32_t length = std::min(size, extent);
  std::vector<Side> sides;
  for (std::uint32_t x = 0; x + length <= extent; x += std::max(1U, size / 4)) {
    sides.push_back({x, length});
  }
  return sides;
}

std::vector<Rectangle> product(const std::vector<Side>& rows, const std::vector<Side>& columns) {
  std::vector<Rectangle> windows;
  windows.reserve(rows.size() * columns.size());
  for (const Side& row : rows) {
    for (const Side& column : columns) {
      windows.push_back({column.start, row.start, column.length, row.length});
    }
  }
  return windows;
}

bool any_between(const std::vector<Side>& sides, std::uint32_t size) {
  return std::ranges::any_of(sides, [&](const Side& side) { return side.start % size != 0; });
}

void add_level(std::vector<WindowGroup>& groups, const ImageExtent& extent, std::uint32_t size,
               bool listed) {
  const std::uint32_t width = narrow(extent.width);
  const std::uint32_t height = narrow(extent.height);
  const std::vector<Side> rows = shifted_sides(height, size);
  const std::vector<Side> columns = shifted_sides(width, size);
  groups.push_back({size, Grid::aligned, 0, {}});
  if (listed)
    groups.back().windows = product(aligned_sides(height, size), aligned_sides(width, size));
  if (!any_between(rows, size) && !any_between(columns, size)) return;
  groups.push_back({size, Grid::shifted, 0, {}});
  if (!listed) return;
  std::vector<Rectangle>& shifted = groups.back().windows;
  shifted = product(rows, columns);
  std::erase_if(shifted, [&](const Rectangle& w) { return w.x % size == 0 && w.y % size == 0; });
}

// The whole image has whole_share of the level, all other sizes have equal shares. A size's aligned
// and shifted cells have equal parts of it.
void share_out(std::vector<WindowGroup>& groups, std::size_t sizes, double share) {
  const double whole_part = sizes == 1 ? share : whole_image_share;
  const std::uint32_t whole = groups.back().size;
  for (WindowGroup& group : groups) {
    const auto parts = std::count_if(groups.begin(), groups.end(),
                                     [&](const WindowGroup& g) { return g.size == group.size; });
    const double of_size =
        group.size == whole ? whole_part : (share - whole_part) / static_cast<double>(sizes - 1);
    group.share = of_size / static_cast<double>(parts);
  }
}

}  // namespace

std::vector<WindowGroup> window_groups(const ImageExtent& extent, std::uint32_t listed) {
  const std::uint32_t longest = narrow(std::max(extent.width, extent.height));
  std::vector<std::uint32_t> sizes;
  for (std::uint32_t size = 1; size < longest; size *= 2) sizes.push_back(size);
  sizes.push_back(longest);
  std::vector<WindowGroup> groups;
  for (const std::uint32_t size : sizes)
    add_level(groups, extent, size, size >= listed || size == longest);
  if (longest == 1) {
    share_out(groups, sizes.size(), 1);
    return groups;
  }
  share_out(groups, sizes.size(), 1 - alternating_share);
  const Rectangle whole{0, 0, narrow(extent.width), narrow(extent.height)};
  groups.push_back({longest, Grid::alternating, alternating_share, {whole, whole, whole}});
  return groups;
}

WindowSums::WindowSums(const ImageExtent& extent)
    : width_(extent.width), table_((extent.width + 1) * (extent.height + 1)) {}

void WindowSums::load(std::span<const double> values) {
  const std::size_t stride = width_ + 1;
  const std::size_t height = values.size() / width_;
  for (std::size_t y = 0; y < height; ++y) {
    double row = 0;
    for (std::size_t x = 0; x < width_; ++x) {
      row += values[y * width_ + x];
      table_[(y + 1) * stride + x + 1] = table_[y * stride + x + 1] + row;
    }
  }
}

double WindowSums::of(const Rectangle& window) const {
  const std::size_t stride = width_ + 1;
  const double* const top = table_.data() + window.y * stride + window.x;
  const double* const bottom = top + window.height * stride;
  return (bottom[window.width] - bottom[0]) - (top[window.width] - top[0]);
}

double adjusted(double log_p, GroupSize group) {
  // Below 1e-300 the union bound is the same number, and exp(log_p) may be zero.
  const double one_of_all = log_p < -690
                                ? log_p + std::log(group.count)
                                : log_complement(group.count * std::log1p(-std::exp(log_p)));
  return std::min(0.0, one_of_all - std::log(group.share));
}

double unadjusted(double log_p, GroupSize group) {
  return log_complement(std::log1p(-group.share * std::exp(log_p)) / group.count);
}

double standard_error_at(const CellNoiseOfMean& noise, double errors) {
  const double half = errors * noise.growth / 2;
  return half + std::sqrt(half * half + noise.variance);
}

void leave_share(ImageFamily& family, double share) {
  for (ImageFinding& group : family.groups) {
    group.adjusted_log_p = std::min(0.0, group.adjusted_log_p - std::log1p(-share));
  }
}

void decide(ImageFamily& family) {
  if (family.groups.empty()) return;
  family.winner = *std::ranges::min_element(family.groups, {}, &ImageFinding::adjusted_log_p);
  family.log_p = family.winner.adjusted_log_p;
  const ImageFinding likeliest = family.winner;
  const double least = likeliest.adjusted_log_p;
  const double unlikely =
      std::min(as_unlikely * least, std::max(least, std::log(1 - confidence_at_place)));
  std::vector<ImageFinding> there;
  const auto add_those_there = [&](const std::vector<ImageFinding>& cells) {
    std::ranges::copy_if(cells, std::back_inserter(there), [&](const ImageFinding& cell) {
      return !cell.alternation && cell.effect.standard_error > 0 &&
             overlap(cell.window, likeliest.window) && cell.adjusted_log_p <= unlikely &&
             (likeliest.alternation || cell.z * likeliest.z > 0);
    });
  };
  add_those_there(family.groups);
  add_those_there(family.clearest);
  if (there.empty()) return;
  const ImageFinding clearest = *std::ranges::max_element(there, {}, errors_of);
  std::ranges::stable_sort(there, {}, &ImageFinding::size);
  family.winner = *std::ranges::find_if(there, [&](const ImageFinding& cell) {
    return cell.channel == clearest.channel && is_inside(cell.window, clearest.window) &&
           errors_of(cell) >= as_clear * errors_of(clearest);
  });
  family.winner.adjusted_log_p = family.log_p;
}

double UnseenElement::z() const {
  if (certain()) return sign * certain_z;
  return sign * normal_quantile({Tail::upper, log_p - std::numbers::ln2});
}

void add_unseen(const ImageExtent& extent, ImageFamily& family) {
  constexpr double share = 0.02;
  leave_share(family, share);
  if (family.unseen.empty()) return;
  const UnseenElement& least = *std::ranges::min_element(family.unseen, {}, &UnseenElement::log_p);
  const std::size_t channel = least.element % extent.channels;
  std::size_t left = extent.width, right = 0, top = extent.height, bottom = 0;
  for (const UnseenElement& each : family.unseen) {
    if (each.log_p != least.log_p || each.sign != least.sign) continue;
    if (each.element % extent.channels != channel) continue;
    const std::size_t x = each.element % extent.row() / extent.channels;
    const std::size_t y = each.element / extent.row();
    left = std::min(left, x);
    right = std::max(right, x);
    top = std::min(top, y);
    bottom = std::max(bottom, y);
  }
  const double elements = static_cast<double>(extent.elements());
  family.groups.push_back(
      {.window = {narrow(left), narrow(top), narrow(right + 1 - left), narrow(bottom + 1 - top)},
       .channel = channel,
       .z = least.certain() ? least.sign * std::numeric_limits<double>::infinity() : least.z(),
       .log_p = least.log_p,
       .adjusted_log_p = std::min(0.0, least.log_p + std::log(elements / share))});
}

}  // namespace assay::stats
