#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "stats/check.h"
#include "stats/image_best_cell.h"
#include "stats/image_coarse_cells.h"
#include "stats/image_fine_cells.h"
#include "stats/image_halves.h"
#include "stats/image_pyramid.h"
#include "stats/image_welch.h"
#include "stats/tails.h"

namespace assay::stats {
namespace {

using Groups = std::vector<WindowGroup>;

constexpr const char* function_name = "image_pyramid";

double two_sided(LogTails tails) {
  return std::min(0.0, std::numbers::ln2 + std::min(tails.lower, tails.upper));
}

LogTails tails_of(StudentValue value) {
  return std::isinf(value.degrees) ? normal_tails(value.t)
                                   : student_t_tails(value.t, value.degrees);
}

// u of the header, and the normal upper tail of its self-normalised sum.
void offer_energy(BestCell& best, const ImageExtent& extent, const std::array<Half, halves>& half,
                  std::size_t channel, const ImageReference* reference) {
  double sum = 0;
  double squares = 0;
  for (std::size_t i = channel; i < extent.elements(); i += extent.channels) {
    const double w0 = half[0].weight[i];
    const double w1 = half[1].weight[i];
    const double d0 = half[0].difference[i];
    const double d1 = half[1].difference[i];
    const double error =
        reference == nullptr ? 0 : check::reference_error(function_name, *reference, i);
    const double u = w1 * w1 * (d0 * d0 - half[0].variance[i]) +
                     w0 * w0 * (d1 * d1 - half[1].variance[i]) +
                     2 * w0 * w1 * (d0 * d1 - error * error);
    sum += u;
    squares += u * u;
  }
  if (squares == 0) return;
  ++best.windows;
  const double z = sum / std::sqrt(squares);
  if (best.windows > 1 && z <= best.finding.z) return;
  best.finding = whole_image(ImageStatistic::energy, extent);
  best.finding.channel = channel;
  best.finding.z = z;
}

template <class Real>
WelchCounts element_map(const ImagePair<Real>& pair, std::span<double> z, const ForEach& for_each) {
  constexpr std::size_t at_a_time = std::size_t{1} << 15;
  std::vector<WelchCounts> counts((z.size() + at_a_time - 1) / at_a_time);
  for_each(counts.size(), [&](std::size_t i) {
    const std::size_t first = i * at_a_time;
    const std::span<double> some = z.subspan(first, std::min(at_a_time, z.size() - first));
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

// Single elements: the best by z, its p-value exactly.
template <class Real>
void add_elements(ImageFamily& family, const ImagePair<Real>& pair, const PyramidOptions& options,
                  double share) {
  std::vector<double> own(options.z.empty() ? pair.a.extent.elements() : 0);
  const std::span<double> z = options.z.empty() ? std::span(own) : options.z;
  const WelchCounts counts = element_map(pair, z, options.for_each);
  family.tested = counts.tested;
  family.equal_constants = counts.equal_constants;
  family.different_constants = counts.different_constants;
  const bool wanted = options.smallest <= 1 && counts.tested > 0;
  if (!wanted && counts.different_constants == 0) return;
  const std::size_t element = largest(z);
  ImageFinding finding = certain_finding(pair.a.extent, element, z[element]);
  if (counts.different_constants == 0) {
    finding.z = z[element];
    finding.log_p = element_log_p(pair, element);
    finding.adjusted_log_p = adjusted(finding.log_p, {static_cast<double>(counts.tested), share});
  }
  family.groups.push_back(finding);
}

void add_best_windows(ImageFamily& family, const std::vector<BestCell>& best, const Groups& groups,
                      std::uint32_t smallest) {
  for (std::size_t g = 1; g < groups.size(); ++g) {
    if (best[g].windows == 0 || groups[g].size < smallest) continue;
    ImageFinding finding = best[g].finding;
    finding.log_p = two_sided(tails_of(best[g].value));
    finding.adjusted_log_p = adjusted(finding.log_p, {best[g].windows, groups[g].share});
    family.groups.push_back(finding);
  }
}

// The energy's channels may depend on each other: the union bound joins them.
void add_best_energy(ImageFamily& family, const BestCell& best) {
  if (best.windows == 0) return;
  ImageFinding finding = best.finding;
  finding.log_p = normal_tails(finding.z).upper;
  finding.adjusted_log_p = std::min(0.0, finding.log_p + std::log(best.windows / energy_share));
  family.groups.push_back(finding);
}

void check_weights(std::span<const double> weights, const ImageExtent& extent) {
  if (!weights.empty() && weights.size() != extent.elements()) {
    check::fail({function_name, "weights.size()"}, weights.size(), "that of the elements");
  }
  for (const double weight : weights) check::non_negative({function_name, "weights"}, weight);
}

template <class Real>
ImageFamily family_of(const ImagePair<Real>& pair, const PyramidOptions& options) {
  const ImageExtent& extent = pair.a.extent;
  check_weights(options.weights, extent);
  if (!options.z.empty() && options.z.size() != extent.elements()) {
    check::fail({function_name, "z.size()"}, options.z.size(), "that of the elements");
  }
  const Groups groups = window_groups(extent, 1 - energy_share);
  ImageFamily family;
  add_elements(family, pair, options, groups[0].share);
  if (family.different_constants == 0) {
    auto half = halves_of(pair, options.for_each);
    if (!options.weights.empty()) {
      for (Half& each : half) each.weight.assign(options.weights.begin(), options.weights.end());
    }
    std::vector<BestCell> best(groups.size());
    BestCell energy;
    const CoarseImages coarse =
        offer_fine_cells<Real>({pair, half, groups}, best, options.for_each);
    std::vector<std::vector<BestCell>> of_channels(extent.channels,
                                                   std::vector<BestCell>(groups.size()));
    options.for_each(extent.channels,
                     [&](std::size_t c) { offer_coarse_cells(coarse, groups, c, of_channels[c]); });
    for (std::size_t c = 0; c < extent.channels; ++c) {
      for (std::size_t g = 0; g < groups.size(); ++g) join(best[g], of_channels[c][g]);
      if (options.energy) offer_energy(energy, extent, half, c, pair.reference);
    }
    add_best_windows(family, best, groups, options.smallest);
    add_best_energy(family, energy);
  }
  decide(family);
  return family;
}

}  // namespace

double whole_image_share(const ImageExtent& extent) {
  const Groups groups = window_groups(extent, 1 - energy_share);
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

template ImageFamily image_pyramid(const ImageStack<float>&, const ImageStack<float>&,
                                   const PyramidOptions&);
template ImageFamily image_pyramid(const ImageStack<double>&, const ImageStack<double>&,
                                   const PyramidOptions&);
template ImageFamily image_pyramid(const ImageStack<float>&, const ImageReference&,
                                   const PyramidOptions&);
template ImageFamily image_pyramid(const ImageStack<double>&, const ImageReference&,
                                   const PyramidOptions&);

}  // namespace assay::stats
