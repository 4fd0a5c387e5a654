#include "stats/images/image_equivalence.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <span>
#include <tuple>

#include "stats/basics/check.h"
#include "stats/basics/vector_copies.h"
#include "stats/gates/assumption_gates.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr const char* function_name = "image_distance";

using Terms = DistanceSums::Terms;

constexpr std::size_t block_size = 512;
using Block = std::array<double, block_size>;

// ---- A block of elements, beyond whose end are zeros

// Means and squared errors.
struct Estimates {
  Block mean{};
  Block squared_error{};
};

// One side: a stack or a reference. A stack's moments go to `moments` too, if it has room.
void load(const ImageStack* stack, const ImageReference& reference, ElementRange range,
          Estimates& out, MomentArrays moments) {
  out = {};
  if (stack != nullptr) {
    const std::span<double> mean = std::span(out.mean).first(range.size());
    const std::span<double> m2 = std::span(out.squared_error).first(range.size());
    moments_of_range(*stack, range.first, {mean, m2});
    if (!moments.mean.empty()) {
      std::ranges::copy(mean, moments.mean.begin());
      std::ranges::copy(m2, moments.m2.begin());
    }
    const double count = static_cast<double>(stack->images.size());
    for (double& squares : out.squared_error) squares /= count * (count - 1);
    return;
  }
  for (std::size_t i = 0; i < range.size(); ++i) {
    const double error = check::reference_error(function_name, reference, range.first + i);
    out.mean[i] = reference.value[range.first + i];
    out.squared_error[i] = error * error;
  }
}

// Adds up products of a replicate's deviations d: with the elements' differences and norms, and
// with themselves. Each of eight numbers has sums of its own, the same on every machine.
constexpr std::size_t lanes = 8;
struct Lanes {
  std::array<double, lanes> differences{};
  std::array<double, lanes> norms{};
  std::array<double, lanes> squares{};
};

ASSAY_VECTOR_COPIES void add_products(const float* values, const Block& means,
                                      const Block& differences, const Block& norms, Lanes& to,
                                      std::size_t first, std::size_t last) {
  Lanes sums = to;
  for (std::size_t i = first; i < last; i += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) {
      const double d = static_cast<double>(values[i - first + k]) - means[i + k];
      sums.differences[k] += differences[i + k] * d;
      sums.norms[k] += norms[i + k] * d;
      sums.squares[k] += d * d;
    }
  }
  to = sums;
}

double sum_of(const std::array<double, lanes>& numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), 0.0);
}

// ---- Sums over blocks

// A replicate deviates from the mean of n by d. Leaving it out moves the mean by -d / (n - 1), and
// the squared error takes d^2 along. Let the common part of all replicates aside. Then D^2 - va -
// vb moves by -2 / (n - 1) (D d - d^2 / (n - 2)). D counts the other way if the replicate is of b.
void add_without(std::vector<Terms>& sums, const ImageStack& stack, ElementRange range,
                 const Block& means, const Block& differences, const Block& norms) {
  sums.resize(stack.images.size());
  const double n = static_cast<double>(stack.images.size());
  const std::size_t size = range.size();
  const std::size_t whole = size / lanes * lanes;
  for (std::size_t r = 0; r < sums.size(); ++r) {
    const float* const values = stack.at(r, range.first);
    Lanes products;
    add_products(values, means, differences, norms, products, 0, whole);
    if (whole < size) {
      std::array<float, lanes> rest{};
      std::copy(values + whole, values + size, rest.begin());
      add_products(rest.data(), means, differences, norms, products, whole, whole + lanes);
    }
    const double squares = sum_of(products.squares) / (n - 2);
    sums[r][0] += -2 / (n - 1) * (sum_of(products.differences) - squares);
    sums[r][1] += -2 / (n - 1) * (sum_of(products.norms) - squares);
  }
}

// Adds up a row.
void add_row(DistanceSums& sums, const ImagePair& pair, ElementRange range,
             const MomentsOfSides& moments) {
  const auto [a, b, differences, back] =
      std::tuple(std::make_unique<Estimates>(), std::make_unique<Estimates>(),
                 std::make_unique<Block>(), std::make_unique<Block>());
  for (std::size_t first = range.first; first < range.last; first += block_size) {
    const ElementRange block{first, std::min(first + block_size, range.last)};
    const auto of_block = [&](std::size_t side) {
      return moments[side].part(first - range.first, block.size());
    };
    load(&pair.a, {}, block, *a, of_block(0));
    load(pair.b, pair.reference, block, *b, of_block(1));
    for (std::size_t i = 0; i < block_size; ++i) {
      const double difference = a->mean[i] - b->mean[i];
      (*differences)[i] = difference;
      (*back)[i] = -difference;
      const double square = difference * difference;
      sums.powers[0] += square;
      sums.powers[1] += square * square;
      sums.whole[0] += square - a->squared_error[i] - b->squared_error[i];
      sums.whole[1] += b->mean[i] * b->mean[i] - b->squared_error[i];
    }
    add_without(sums.without_a, pair.a, block, a->mean, *differences, b->mean);
    if (pair.b != nullptr) add_without(sums.without_b, *pair.b, block, b->mean, *back, b->mean);
  }
}

void add(Terms& to, const Terms& other) {
  for (std::size_t kind = 0; kind < to.size(); ++kind) to[kind] += other[kind];
}
void add(std::vector<Terms>& to, const std::vector<Terms>& others) {
  to.resize(others.size());
  for (std::size_t i = 0; i < to.size(); ++i) add(to[i], others[i]);
}
void add(DistanceSums& to, const DistanceSums& other) {
  add(to.whole, other.whole);
  add(to.powers, other.powers);
  add(to.without_a, other.without_a);
  add(to.without_b, other.without_b);
}

// Covariance of two jackknifed sums: (n - 1) / n times the sum of products about the means.
double covariance(const std::vector<Terms>& values, std::size_t i, std::size_t j) {
  if (values.empty()) return 0;
  const double n = static_cast<double>(values.size());
  Terms mean{};
  for (const Terms& value : values) {
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += value[k] / n;
  }
  double products = 0;
  for (const Terms& value : values) products += (value[i] - mean[i]) * (value[j] - mean[j]);
  return products * (n - 1) / n;
}

// ---- A reference's own error

// In standard errors. One error common to all elements moves all differences alike, and with them
// its own estimated variance.
constexpr double reach = 2;

}  // namespace

// Sums over rows are added up in order.
void RowDistance::take(const ImagePair& pair, RowRange rows, const ForEach& for_each,
                       const MomentsOfSides& moments) {
  check::image_pair(function_name, pair);
  std::vector<DistanceSums> each(rows.last - rows.first);
  const std::size_t row = pair.a.extent.row();
  for_each(each.size(), [&](std::size_t i) {
    const std::size_t first = (rows.first + i) * row;
    add_row(each[i], pair, {first, first + row},
            {moments[0].part(i * row, row), moments[1].part(i * row, row)});
  });
  for (const DistanceSums& of_row : each) add(sums_, of_row);
}

ImageDistance RowDistance::distance() const {
  for (const double sum : sums_.whole) {
    if (!std::isfinite(sum)) check::fail({function_name, "sum over the image"}, sum, "finite");
  }
  const auto& [whole, without_a, without_b, powers] = sums_;
  const std::size_t fewest =
      without_b.empty() ? without_a.size() : std::min(without_a.size(), without_b.size());
  // The norm is of b alone.
  return {.squared_bias = whole[0],
          .squared_norm = whole[1],
          .bias_variance = covariance(without_a, 0, 0) + covariance(without_b, 0, 0),
          .norm_variance = covariance(without_b, 1, 1),
          .covariance = covariance(without_b, 0, 1),
          .degrees = static_cast<double>(fewest - 1),
          .elements = powers[0] * powers[0] / powers[1]};
}

ImageDistance image_distance(const ImagePair& pair, const ForEach& for_each) {
  RowDistance rows;
  rows.take(pair, {0, pair.a.extent.height}, for_each);
  return rows.distance();
}

ImageDistance relative_to(ImageDistance distance, const ImageDistance& norm) {
  distance.squared_norm = norm.squared_bias;
  distance.norm_variance = norm.bias_variance;
  distance.covariance = 0;
  return distance;
}

ImageDistance with_reference_error(ImageDistance distance, const ImagePair& pair,
                                   ElementErrors errors) {
  constexpr const char* function = "with_reference_error";
  check::image_pair(function, pair);
  const ImageStack& a = pair.a;
  const ImageReference& b = pair.reference;
  if (b.standard_error.empty()) return distance;
  std::vector<double> mean(a.extent.elements());
  std::vector<double> m2(mean.size());
  moments_of_range(a, 0, {mean, m2});
  const double count = static_cast<double>(a.images.size());
  const bool independent = errors == ElementErrors::independent;
  double bias = 0, norm = 0, covariance = 0, root_bias = 0, root_norm = 0;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    const double error = check::reference_error(function, b, i);
    const double squared = error * error;
    const double squared_error = m2[i] / (count * (count - 1));
    const double difference = mean[i] - b.value[i];
    const double noise = squared_error + squared;
    const double square = independent
                              ? std::max(0.0, difference * difference - noise)
                              : std::pow(std::abs(difference) + reach * std::sqrt(noise), 2);
    const double second_order = 2 * squared * squared;
    const double of_bias = 4 * (square + squared_error) * squared + second_order;
    const double of_norm =
        4 * std::max(0.0, b.value[i] * b.value[i] - squared) * squared + second_order;
    bias += of_bias;
    norm += of_norm;
    covariance += -4 * difference * b.value[i] * squared - second_order;
    root_bias += std::sqrt(of_bias);
    root_norm += std::sqrt(of_norm);
  }
  distance.bias_variance += independent ? bias : root_bias * root_bias;
  distance.norm_variance += independent ? norm : root_norm * root_norm;
  distance.covariance += independent ? covariance : -root_bias * root_norm;
  return distance;
}

double variance_at(const ImageDistance& distance, double squared_margin) {
  return distance.bias_variance - 2 * squared_margin * distance.covariance +
         squared_margin * squared_margin * distance.norm_variance;
}

TestResult squared_margin_test(const ImageDistance& distance, double squared_margin) {
  const double variance = variance_at(distance, squared_margin);
  if (!(variance > 0)) throw ZeroVariance("image_equivalence: zero standard error");
  const double t =
      (distance.squared_bias - squared_margin * distance.squared_norm) / std::sqrt(variance);
  return by_tails(t, {"student-t", {distance.degrees}}, student_t_tails(t, distance.degrees));
}

namespace {

constexpr double never = std::numeric_limits<double>::lowest();

// The natural logarithm of the p-value of "one of the means is `margin` off or more".
double log_p_of_means(const ThetaOfImages& theta, double margin) {
  double log_p = never;
  for (const Reference& mean : theta.of_means) {
    const double beyond = (mean.value - margin) / mean.standard_error;
    if (mean.standard_error > 0) {
      log_p = std::max(log_p, student_t_tails(beyond, theta.of_elements.degrees).lower);
    } else if (mean.value >= margin) {
      log_p = 0;
    }
  }
  return log_p;
}

TestResult test_of_squares(const ThetaOfImages& theta, double margin) {
  ImageDistance at_least_zero = theta.of_elements;
  at_least_zero.squared_bias = std::max(0.0, at_least_zero.squared_bias);
  const auto at = [](const ImageDistance& of, double root) {
    return squared_margin_test(of, std::copysign(root * root, root));
  };
  const double least = margin - theta.hidden;
  TestResult result = at(theta.of_elements, margin + theta.hidden);
  if (theta.share > 0)
    result.log_p_upper = std::min(0.0, result.log_p_upper - std::log(theta.share));
  result.log_p_lower = std::max(at(at_least_zero, least).log_p_lower, log_p_of_means(theta, least));
  return result;
}

}  // namespace

double ThetaOfImages::estimate() const {
  return std::sqrt(std::max(0.0, of_elements.squared_bias / of_elements.squared_norm));
}

bool ThetaOfImages::exact() const {
  return !(variance_at(of_elements, of_elements.squared_bias / of_elements.squared_norm) > 0);
}

std::vector<Reference> distances_of_means(const ChannelMeans& a, const ChannelMeans& b,
                                          const ImageExtent& extent, double squared_norm) {
  const double scale = std::sqrt(static_cast<double>(extent.width * extent.height) / squared_norm);
  const std::vector<double> errors = uniform_errors(a, b);
  std::vector<Reference> distances;
  for (std::size_t c = 0; c < errors.size(); ++c) {
    distances.push_back({scale * std::abs(a[c].value - b[c].value), scale * errors[c]});
  }
  return distances;
}

TestResult theta_test(const ThetaOfImages& theta, double margin) {
  return theta.exact() ? without_error(theta.estimate() - margin, "exact")
                       : test_of_squares(theta, margin);
}

Interval theta_interval(const ThetaOfImages& theta, double confidence) {
  if (theta.exact()) return {theta.estimate(), theta.estimate(), confidence};
  const ImageDistance& distance = theta.of_elements;
  const double step = std::sqrt(distance.bias_variance) / distance.squared_norm;
  const auto at_square = [&](double square) {
    return test_of_squares(theta, std::copysign(std::sqrt(std::abs(square)), square));
  };
  const Interval squared = interval_by_inversion(
      at_square, {.estimate = distance.squared_bias / distance.squared_norm, .step = step},
      confidence);
  return {std::sqrt(std::max(0.0, squared.low)), std::sqrt(std::max(0.0, squared.high)),
          confidence};
}

Evidence image_evidence(const ThetaOfImages& theta, const TestResult& of_places, double alpha) {
  TestResult equal = of_places;
  if (theta.share > 0 && equal.log_p_upper > std::log(alpha) &&
      theta.of_elements.elements >= fewest_effective_observations) {
    TestResult by_distance = theta_test(theta, 0);
    by_distance.log_p_lower = 0;
    if (by_distance.log_p_upper < equal.log_p_upper) equal = by_distance;
  }
  const auto at = [=](double margin) {
    if (!(margin > 0)) return equal;
    TestResult result = theta_test(theta, margin);
    if (theta.share > 0) result.log_p_upper = std::max(result.log_p_upper, equal.log_p_upper);
    return result;
  };
  return {.estimate = theta.estimate(),
          .at = at,
          .interval = [=](double confidence) { return theta_interval(theta, confidence); },
          .distance = true,
          .exact = theta.exact()};
}

double deciding_replicates(const ThetaOfImages& theta, double margin, double beta,
                           double replicates) {
  constexpr double least_factor = 1.1;
  constexpr double most_factor = 1e6;
  const ImageDistance& distance = theta.of_elements;
  const double estimate = std::max(0.0, distance.squared_bias / distance.squared_norm);
  const double errors = 1 - student_t_quantile({Tail::lower, std::log(beta)}, distance.degrees);
  const double of_square = errors * std::sqrt(distance.bias_variance) / distance.squared_norm;
  const double decay = theta.hidden > 0 ? theta.hidden_of_twice / theta.hidden : 0;
  const auto decides = [&](double factor) {
    const double least = margin - theta.hidden * std::pow(decay, factor - 1);
    const double error = of_square / (estimate > 0 ? std::sqrt(factor) : factor);
    return least > 0 && error < least * least - estimate &&
           std::ranges::all_of(theta.of_means, [&](const Reference& mean) {
             return errors * mean.standard_error / std::sqrt(factor) < least - mean.value;
           });
  };
  const bool below =
      margin * margin > estimate && std::ranges::all_of(theta.of_means, [&](const Reference& mean) {
        return margin > mean.value;
      });
  double factor = least_factor;
  while (factor < most_factor && !decides(factor)) factor *= least_factor;
  return below ? replicates * factor : 0;
}

}  // namespace assay::stats
