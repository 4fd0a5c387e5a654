#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "stats/basics/check.h"
#include "stats/images/image_halves.h"
#include "stats/images/image_welch.h"
#include "stats/pyramids/image_best_cell.h"
#include "stats/pyramids/image_coarse_cells.h"
#include "stats/pyramids/image_fine_cells.h"
#include "stats/pyramids/image_pyramid.h"
#include "stats/pyramids/image_row_pyramid.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr const char* function_name = "image_pyramid";

// Whole images are also taken in pieces of so many rows, because intermediate data is not kept for
// all elements.
constexpr std::size_t rows_at_a_time = 512;

LogTails tails_of(StudentValue value) {
  return std::isinf(value.degrees) ? normal_tails(value.t)
                                   : student_t_tails(value.t, value.degrees);
}

// u of the header for one element.
double energy_of(const std::array<Half, halves>& half, std::size_t element,
                 const ImageReference* reference) {
  const std::size_t i = element - half[0].first;
  const double w0 = half[0].weight[i];
  const double w1 = half[1].weight[i];
  const double d0 = half[0].difference[i];
  const double d1 = half[1].difference[i];
  const double error =
      reference == nullptr ? 0 : check::reference_error(function_name, *reference, element);
  return w1 * w1 * (d0 * d0 - half[0].variance[i]) + w0 * w0 * (d1 * d1 - half[1].variance[i]) +
         2 * w0 * w1 * (d0 * d1 - error * error);
}

template <class Real>
WelchCounts element_map(const ImagePair<Real>& pair, std::size_t begin, std::span<double> z,
                        const ForEach& for_each) {
  constexpr std::size_t at_a_time = std::size_t{1} << 15;
  std::vector<WelchCounts> counts((z.size() + at_a_time - 1) / at_a_time);
  for_each(counts.size(), [&](std::size_t i) {
    const std::size_t done = i * at_a_time;
    const std::size_t first = begin + done;
    const std::span<double> some = z.subspan(done, std::min(at_a_time, z.size() - done));
    counts[i] = pair.b != nullptr ? welch_z(pair.a, *pair.b, first, some)
                                  : welch_z(pair.a, *pair.reference, first, some);
  });
  WelchCounts all;
  for (const WelchCounts& some : counts) all.merge(some);
  return all;
}

template <class Real>
double element_log_p(const ImagePair<Real>& pair, std::size_t element) {
  return log_p_two_sided(pair.b != nullptr ? welch_element(pair.a, *pair.b, element)
                                           : welch_element(pair.a, *pair.reference, element));
}

std::size_t largest(std::span<const double> z) {
  const auto at = std::max_element(z.begin(), z.end(),
                                   [](double a, double b) { return std::abs(a) < std::abs(b); });
  return static_cast<std::size_t>(at - z.begin());
}

void check_weights(std::span<const double> weights, const ImageExtent& extent) {
  if (!weights.empty() && weights.size() != extent.elements()) {
    check::fail({function_name, "weights.size()"}, weights.size(), "that of the elements");
  }
  for (const double weight : weights) check::non_negative({function_name, "weights"}, weight);
}

template <class Real>
ImageFamily family_of(const ImagePair<Real>& pair, const PyramidOptions& options) {
  RowPyramid<Real> pyramid(pair, options);
  const std::size_t height = pair.a.extent.height;
  for (std::size_t row = 0; row < height; row += rows_at_a_time) {
    pyramid.take(pair, {row, std::min(row + rows_at_a_time, height)});
  }
  return pyramid.family();
}

template <class Real>
void check_pair(const ImagePair<Real>& pair) {
  check::image_stack(function_name, pair.a);
  if (pair.b != nullptr) {
    check::image_stack(function_name, *pair.b);
    check::same_extent(function_name, pair.a.extent, pair.b->extent);
  } else {
    check::image_reference(function_name, *pair.reference);
    check::same_extent(function_name, pair.a.extent, pair.reference->extent);
  }
}

}  // namespace

template <class Real>
RowPyramid<Real>::RowPyramid(const ImagePair<Real>& pair, const PyramidOptions& options)
    : extent_(pair.a.extent), options_(options) {
  check_pair(pair);
  check_weights(options.weights, extent_);
  if (!options.z.empty() && options.z.size() != extent_.elements()) {
    check::fail({function_name, "z.size()"}, options.z.size(), "that of the elements");
  }
  if (options.z.empty()) own_z_.resize(extent_.elements());
  z_ = options.z.empty() ? std::span(own_z_) : options.z;
  groups_ = window_groups(extent_, 1 - energy_share, coarse_size);
  found_ = {empty_blocks(pair), std::vector<BestCell>(groups_.size())};
  energy_.resize(extent_.channels);
}

template <class Real>
void RowPyramid<Real>::take(const ImagePair<Real>& pair, RowRange rows) {
  take_elements(pair, rows);
  if (counts_.different_constants == 0) take_cells(pair, rows);
}

// The z of these elements count for nothing, as if both sides were equal there.
template <class Real>
void RowPyramid<Real>::leave_to_sums(ElementRange range) {
  const std::span<const std::size_t> all = options_.only_in_sums;
  const auto first = std::lower_bound(all.begin(), all.end(), range.first);
  for (auto each = first; each != all.end() && *each < range.last; ++each) {
    (std::isfinite(z_[*each]) ? counts_.tested : counts_.different_constants) -= 1;
    counts_.equal_constants += 1;
    z_[*each] = 0;
  }
}

// The best element by z, with its exact p-value.
template <class Real>
void RowPyramid<Real>::take_elements(const ImagePair<Real>& pair, RowRange rows) {
  const ElementRange range = rows.elements(extent_);
  const std::span<double> z = z_.subspan(range.first, range.size());
  counts_.merge(element_map(pair, range.first, z, options_.for_each));
  leave_to_sums(range);
  const std::size_t element = range.first + largest(z);
  if (std::abs(z_[element]) <= std::abs(z_[best_element_]) && element != best_element_) return;
  best_element_ = element;
  if (std::isfinite(z_[element]) && z_[element] != 0) best_log_p_ = element_log_p(pair, element);
}

template <class Real>
void RowPyramid<Real>::take_cells(const ImagePair<Real>& pair, RowRange rows) {
  const RowRange reached{rows.first, std::min(rows.last + fine_rows_ahead, extent_.height)};
  std::array<Half, halves> half = halves_of(pair, reached, options_.for_each);
  for (Half& each : half) {
    if (options_.weights.empty()) continue;
    const auto weights = options_.weights.subspan(each.first, each.weight.size());
    each.weight.assign(weights.begin(), weights.end());
  }
  offer_fine_cells<Real>({pair, half, groups_}, rows, found_, options_.for_each);
  const ElementRange range = rows.elements(extent_);
  options_.for_each(options_.energy ? extent_.channels : 0, [&](std::size_t channel) {
    Energy& energy = energy_[channel];
    for (std::size_t i = range.first + channel; i < range.last; i += extent_.channels) {
      const double u = energy_of(half, i, pair.reference);
      energy.sum += u;
      energy.squares += u * u;
    }
  });
}

template <class Real>
void RowPyramid<Real>::add_elements(ImageFamily& family) const {
  family.tested = counts_.tested;
  family.equal_constants = counts_.equal_constants;
  family.different_constants = counts_.different_constants;
  if (counts_.tested == 0 && counts_.different_constants == 0) return;
  ImageFinding finding = certain_finding(extent_, best_element_, z_[best_element_]);
  if (counts_.different_constants == 0) {
    finding.z = z_[best_element_];
    finding.log_p = best_log_p_;
    finding.adjusted_log_p =
        adjusted(finding.log_p, {static_cast<double>(counts_.tested), groups_[0].share});
  }
  family.groups.push_back(finding);
}

template <class Real>
void RowPyramid<Real>::add_best_windows(ImageFamily& family) const {
  for (std::size_t g = 1; g < groups_.size(); ++g) {
    const BestCell& best = found_.best[g];
    if (best.windows == 0) continue;
    ImageFinding finding = best.finding;
    finding.log_p = log_p_two_sided(tails_of(best.value));
    finding.adjusted_log_p = adjusted(finding.log_p, {best.windows, groups_[g].share});
    family.groups.push_back(finding);
  }
}

// The largest energy of the channels. They may depend on each other, so the union bound joins them.
template <class Real>
void RowPyramid<Real>::add_best_energy(ImageFamily& family) const {
  ImageFinding best = whole_image(ImageStatistic::energy, extent_);
  double channels = 0;
  for (std::size_t c = 0; c < energy_.size(); ++c) {
    if (energy_[c].squares == 0) continue;
    const double z = energy_[c].sum / std::sqrt(energy_[c].squares);
    if (channels++ > 0 && z <= best.z) continue;
    best.channel = c;
    best.z = z;
  }
  if (channels == 0) return;
  best.log_p = normal_tails(best.z).upper;
  best.adjusted_log_p = std::min(0.0, best.log_p + std::log(channels / energy_share));
  family.groups.push_back(best);
}

template <class Real>
ImageFamily RowPyramid<Real>::family() {
  ImageFamily family;
  add_elements(family);
  if (family.different_constants == 0) {
    add_up_alternating(found_.coarse);
    std::vector<std::vector<BestCell>> of_channels(extent_.channels,
                                                   std::vector<BestCell>(groups_.size()));
    options_.for_each(extent_.channels, [&](std::size_t c) {
      offer_coarse_cells(found_.coarse, groups_, c, of_channels[c]);
    });
    for (const std::vector<BestCell>& of_channel : of_channels) {
      for (std::size_t g = 0; g < groups_.size(); ++g) join(found_.best[g], of_channel[g]);
    }
    add_best_windows(family);
    add_best_energy(family);
  }
  decide(family);
  leave_out(family, {.smallest = options_.smallest});
  return family;
}

double whole_image_share(const ImageExtent& extent) {
  constexpr auto none = std::numeric_limits<std::uint32_t>::max();
  const std::vector<WindowGroup> groups = window_groups(extent, 1 - energy_share, none);
  const auto whole = std::max_element(
      groups.begin(), groups.end(), [](const WindowGroup& a, const WindowGroup& b) {
        const auto rank = [](const WindowGroup& g) { return g.grid == Grid::aligned ? g.size : 0; };
        return rank(a) < rank(b);
      });
  return whole->share;
}

template <class Real>
ImageFamily image_pyramid(const ImageStack<Real>& a, const ImageStack<Real>& b,
                          const PyramidOptions& options) {
  return family_of<Real>({a, &b, nullptr}, options);
}

template <class Real>
ImageFamily image_pyramid(const ImageStack<Real>& a, const ImageReference& b,
                          const PyramidOptions& options) {
  return family_of<Real>({a, nullptr, &b}, options);
}

template class RowPyramid<float>;
template class RowPyramid<double>;
template ImageFamily image_pyramid(const ImageStack<float>&, const ImageStack<float>&,
                                   const PyramidOptions&);
template ImageFamily image_pyramid(const ImageStack<double>&, const ImageStack<double>&,
                                   const PyramidOptions&);
template ImageFamily image_pyramid(const ImageStack<float>&, const ImageReference&,
                                   const PyramidOptions&);
template ImageFamily image_pyramid(const ImageStack<double>&, const ImageReference&,
                                   const PyramidOptions&);

}  // namespace assay::stats
