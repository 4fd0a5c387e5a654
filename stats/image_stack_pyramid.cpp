#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "stats/check.h"
#include "stats/image_halves.h"
#include "stats/image_pyramid.h"
#include "stats/image_welch.h"
#include "stats/t_to_z.h"
#include "stats/tails.h"

namespace assay::stats {
namespace {

constexpr const char* function_name = "image_pyramid";
// Sums of one channel's windows, all groups in a row.
class WindowMoments {
 public:
  explicit WindowMoments(std::size_t windows)
      : effect(windows),
        variance(windows),
        reciprocal_degrees(windows),
        mean_(windows),
        m2_(windows) {}

  std::vector<double> effect;              // of a - b, averaged over the halves
  std::vector<double> variance;            // its squared standard error
  std::vector<double> reciprocal_degrees;  // sum of variance_g^2 / (n_g - 1) over the parts

  void add(std::size_t window, double value, double inverse_count) {
    const double delta = value - mean_[window];
    mean_[window] += delta * inverse_count;
    m2_[window] += delta * (value - mean_[window]);
  }

  // The sum did not vary; what is left is the rounding of larger sums that it was taken from.
  void did_not_vary(std::size_t window) { m2_[window] = 0; }

  // The replicates added since the last call are a part whose mean enters with this factor.
  void finish_part(double count, double factor) {
    for (std::size_t i = 0; i < mean_.size(); ++i) {
      const double part = factor * factor * m2_[i] / (count * (count - 1));
      effect[i] += factor * mean_[i];
      variance[i] += part;
      reciprocal_degrees[i] += part * part / (count - 1);
    }
    std::fill(mean_.begin(), mean_.end(), 0.0);
    std::fill(m2_.begin(), m2_.end(), 0.0);
  }

 private:
  std::vector<double> mean_;
  std::vector<double> m2_;
};

using Groups = std::vector<WindowGroup>;

// Group 0 is that of single elements, which welch_z does.
template <class Visit>
void for_each_window(const Groups& groups, const Visit& visit) {
  std::size_t window = 0;
  for (std::size_t g = 1; g < groups.size(); ++g) {
    for (std::size_t i = 0; i < groups[g].windows.size(); ++i) visit(groups[g], i, window++);
  }
}

std::size_t count_windows(const Groups& groups) {
  std::size_t count = 0;
  for (std::size_t g = 1; g < groups.size(); ++g) count += groups[g].windows.size();
  return count;
}

// Of all elements in the window, those that alternate too.
double total_of(const WindowSums& sums, const WindowGroup& group, std::size_t index) {
  return group.grid == Grid::alternating ? sums.of_all() : sums.of(group, index);
}

struct Centre {
  const std::vector<double>& weight;
  const std::vector<unsigned char>& varied;
  std::span<const double> value;  // subtracted first: it cancels, and large sums do not round
  double factor = 1;
};

template <class Real>
void add_half_stack(WindowMoments& moments, const Groups& groups, const ImageStack<Real>& stack,
                    std::size_t half, std::size_t channel, const Centre& centre) {
  const ImageExtent& extent = stack.extent;
  WindowSums sums(extent);
  std::vector<double> values(extent.width * extent.height);
  double count = 0;
  for (std::size_t r = half; r < stack.images.size(); r += halves) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::size_t e = i * extent.channels + channel;
      values[i] = centre.weight[e] * (static_cast<double>(stack.images[r][e]) - centre.value[e]);
    }
    sums.load(values);
    const double inverse = 1 / ++count;
    for_each_window(groups, [&](const WindowGroup& group, std::size_t i, std::size_t window) {
      moments.add(window, sums.of(group, i), inverse);
    });
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t e = i * extent.channels + channel;
    values[i] = centre.weight[e] > 0 && centre.varied[e] > 0 ? 1 : 0;
  }
  sums.load(values);
  for_each_window(groups, [&](const WindowGroup& group, std::size_t i, std::size_t window) {
    if (total_of(sums, group, i) == 0) moments.did_not_vary(window);
  });
  moments.finish_part(count, centre.factor);
}

// A reference's error is one for both halves, independent between elements, and has no degrees of
// freedom to lose. A sum that did not vary stays without variance, untested: the error is not what
// values never seen could add.
void add_reference_error(WindowMoments& moments, const Groups& groups,
                         const ImageReference& reference, const std::array<Half, halves>& half,
                         std::size_t channel) {
  if (reference.standard_error.empty()) return;
  WindowSums sums(reference.extent);
  std::vector<double> values(reference.extent.width * reference.extent.height);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t e = i * reference.extent.channels + channel;
    const double error = (half[0].weight[e] + half[1].weight[e]) / 2 * reference.standard_error[e];
    values[i] = error * error;
  }
  sums.load(values);
  for_each_window(groups, [&](const WindowGroup& group, std::size_t i, std::size_t window) {
    if (moments.variance[window] == 0) return;
    moments.variance[window] += std::max(total_of(sums, group, i), 0.0);
  });
}

template <class Real>
WindowMoments window_moments(const ImagePair<Real>& pair, const Groups& groups,
                             const std::array<Half, halves>& half, std::size_t channel) {
  WindowMoments moments(count_windows(groups));
  std::vector<double> centre;
  if (pair.b != nullptr) centre.assign(pair.b->images[0].begin(), pair.b->images[0].end());
  const std::span<const double> value = pair.b != nullptr ? centre : pair.reference->value;
  for (std::size_t h = 0; h < halves; ++h) {
    const std::vector<double>& weight = half[1 - h].weight;
    add_half_stack(moments, groups, pair.a, h, channel, {weight, half[h].varied, value, 0.5});
    if (pair.b != nullptr) {
      add_half_stack(moments, groups, *pair.b, h, channel, {weight, half[h].varied, value, -0.5});
    }
  }
  if (pair.reference != nullptr) {
    add_reference_error(moments, groups, *pair.reference, half, channel);
  }
  return moments;
}

double two_sided(LogTails tails) {
  return std::min(0.0, std::numbers::ln2 + std::min(tails.lower, tails.upper));
}

LogTails tails_of(StudentValue value) {
  return std::isinf(value.degrees) ? normal_tails(value.t)
                                   : student_t_tails(value.t, value.degrees);
}

// The largest |z| of a group so far, and how many windows it was chosen from.
struct Best {
  ImageFinding finding;
  StudentValue value;
  double windows = 0;
};

void offer(Best& best, const ImageFinding& candidate, StudentValue value) {
  ++best.windows;
  if (best.windows > 1 && std::abs(candidate.z) <= std::abs(best.finding.z)) return;
  best.finding = candidate;
  best.value = value;
}

void offer_windows(std::vector<Best>& best, const Groups& groups, const WindowMoments& moments,
                   std::size_t channel) {
  for_each_window(groups, [&](const WindowGroup& group, std::size_t i, std::size_t window) {
    const double variance = moments.variance[window];
    // Sums that did not vary have none; of two images, constants that differ were found before.
    if (!(variance > 0)) return;
    const StudentValue value{moments.effect[window] / std::sqrt(variance),
                             variance * variance / moments.reciprocal_degrees[window]};
    const auto statistic =
        group.grid == Grid::alternating ? ImageStatistic::alternating : ImageStatistic::window;
    ImageFinding candidate{statistic, group.size, group.windows[i], channel, t_to_z(value), 0, 0};
    if (group.grid == Grid::alternating) candidate.alternation = static_cast<Alternation>(i);
    offer(best[static_cast<std::size_t>(&group - groups.data())], candidate, value);
  });
}

// u of the header, and the normal upper tail of its self-normalised sum.
void offer_energy(Best& best, const ImageExtent& extent, const std::array<Half, halves>& half,
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
WelchCounts element_map(const ImagePair<Real>& pair, std::span<double> z) {
  return pair.b != nullptr ? welch_z(pair.a, *pair.b, 0, z)
                           : welch_z(pair.a, *pair.reference, 0, z);
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
  std::vector<double> z(pair.a.extent.elements());
  const WelchCounts counts = element_map(pair, z);
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

void add_best_windows(ImageFamily& family, const std::vector<Best>& best, const Groups& groups,
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
void add_best_energy(ImageFamily& family, const Best& best) {
  if (best.windows == 0) return;
  ImageFinding finding = best.finding;
  finding.log_p = normal_tails(finding.z).upper;
  finding.adjusted_log_p = std::min(0.0, finding.log_p + std::log(best.windows / energy_share));
  family.groups.push_back(finding);
}

void add_given_energy(ImageFamily& family, const ImageExtent& extent, double log_p) {
  ImageFinding finding = whole_image(ImageStatistic::energy, extent);
  finding.log_p = log_p;
  finding.z =
      log_p < 0 ? normal_quantile({Tail::upper, log_p}) : -std::numeric_limits<double>::infinity();
  finding.adjusted_log_p = std::min(0.0, log_p - std::log(energy_share));
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
  if (options.energy_log_p) {
    check::log_probability({function_name, "energy_log_p"}, *options.energy_log_p);
  }
  const ImageExtent& extent = pair.a.extent;
  check_weights(options.weights, extent);
  const Groups groups = window_groups(extent, 1 - energy_share);
  ImageFamily family;
  add_elements(family, pair, options, groups[0].share);
  if (family.different_constants == 0) {
    auto half = halves_of(pair);
    if (!options.weights.empty()) {
      for (Half& each : half) each.weight.assign(options.weights.begin(), options.weights.end());
    }
    std::vector<Best> best(groups.size());
    Best energy;
    for (std::size_t c = 0; c < extent.channels; ++c) {
      offer_windows(best, groups, window_moments(pair, groups, half, c), c);
      if (!options.energy_log_p) offer_energy(energy, extent, half, c, pair.reference);
    }
    add_best_windows(family, best, groups, options.smallest);
    add_best_energy(family, energy);
    if (options.energy_log_p) add_given_energy(family, extent, *options.energy_log_p);
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
