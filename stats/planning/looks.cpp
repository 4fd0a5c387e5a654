#include "stats/planning/looks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "stats/planning/boundary.h"
#include "stats/planning/planning.h"

namespace assay::stats {
namespace {

constexpr double rounding = 1e-12;

void check_sizes(const char* function, std::span<const std::uint64_t> sizes) {
  check::at_least({function, "looks"}, sizes.size(), 1);
  check::at_least({function, "size"}, sizes.front(), 1);
  const auto out_of_order =
      std::adjacent_find(sizes.begin(), sizes.end(), [](auto a, auto b) { return a >= b; });
  if (out_of_order != sizes.end()) {
    check::fail({function, "size"}, *out_of_order, "below the next look's size");
  }
}

WangTsiatis boundary_of(std::span<const std::uint64_t> sizes) {
  return WangTsiatis(std::vector<double>(sizes.begin(), sizes.end()));
}

std::vector<double> crossing_levels(const WangTsiatis& boundary, double error, double sides) {
  const double constant = boundary.constant(error / sides);
  std::vector<double> levels;
  for (const double shape : boundary.shape()) {
    levels.push_back(sides * std::exp(normal_upper(constant * shape)));
  }
  return levels;
}

double log_p_of_scores(const LookSchedule& schedule, std::span<const double> log_p,
                       double log_sides) {
  // A p-value of 0 has no quantile.
  constexpr double least = -1e300;
  const WangTsiatis boundary = boundary_of(schedule.sizes);
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < log_p.size(); ++k) {
    if (log_p[k] >= log_sides) continue;
    const double z = normal_quantile({Tail::upper, std::max(log_p[k] - log_sides, least)});
    largest = std::max(largest, z / boundary.shape()[k]);
  }
  return std::isinf(largest) ? 0 : std::min(0.0, boundary.log_crossing(largest) + log_sides);
}

}  // namespace

LookSchedule schedule_looks(std::vector<std::uint64_t> sizes, LookLaw law, ErrorRates errors) {
  check_sizes("schedule_looks", sizes);
  planning::check_rates("schedule_looks", errors);
  LookSchedule schedule{.sizes = std::move(sizes), .law = law};
  const std::size_t looks = schedule.count();
  if (law == LookLaw::independent_increments && looks > 1) {
    const WangTsiatis boundary = boundary_of(schedule.sizes);
    schedule.alpha = crossing_levels(boundary, errors.alpha, errors.two_sided ? 2 : 1);
    schedule.beta = crossing_levels(boundary, errors.beta, 1);
    return schedule;
  }
  const double parts = law == LookLaw::unknown ? static_cast<double>(looks) : 1;
  schedule.alpha.assign(looks, errors.alpha / parts);
  schedule.beta.assign(looks, errors.beta / parts);
  return schedule;
}

std::vector<std::uint64_t> geometric_sizes(LookRange range, double growth) {
  check::at_least({"geometric_sizes", "first"}, range.first, 1);
  check::at_least({"geometric_sizes", "last"}, range.last, range.first);
  if (!(growth > 1) || std::isinf(growth)) {
    check::fail({"geometric_sizes", "growth"}, growth, "finite and above 1");
  }
  const double first = static_cast<double>(range.first);
  const double ratio = static_cast<double>(range.last) / first;
  // 1024 = 2^10 is ten doublings, although the logarithms' quotient may round above ten.
  const double steps = std::ceil(std::log(ratio) / std::log(growth) * (1 - rounding));
  std::vector<std::uint64_t> sizes;
  for (double k = 0; k < steps; ++k) {
    const auto size = static_cast<std::uint64_t>(std::round(first * std::pow(ratio, k / steps)));
    if (size >= range.last) break;
    if (sizes.empty() || size > sizes.back()) sizes.push_back(size);
  }
  sizes.push_back(range.last);
  return sizes;
}

LookSchedule one_look(std::uint64_t size, double alpha, double beta) {
  return {.sizes = {size}, .alpha = {alpha}, .beta = {beta}};
}

std::optional<LookSchedule> growing_looks(
    const GrowingLooks& looks,
    const std::function<std::uint64_t(double alpha, double beta)>& size) {
  constexpr std::uint64_t dearest = 4;
  // Each look pays for itself in a union bound, and costs next to nothing otherwise.
  const bool unknown = looks.law == LookLaw::unknown;
  const double growth = unknown ? 2 : std::numbers::sqrt2;
  const auto sizes_up_to = [&](std::uint64_t last, std::size_t count) {
    const double shrunk = static_cast<double>(last) / std::pow(growth, count - 1);
    const auto earliest = static_cast<std::uint64_t>(std::ceil(shrunk));
    return geometric_sizes({.first = std::max(looks.first, earliest), .last = last}, growth);
  };
  const std::size_t all =
      geometric_sizes({.first = looks.first, .last = looks.needed}, growth).size();
  for (std::size_t count = std::min(unknown ? 10 : looks.count, all); count > 1; --count) {
    LookSchedule trial = schedule_looks(sizes_up_to(looks.needed, count), looks.law, looks.errors);
    const std::uint64_t last =
        std::min(looks.most, std::max(looks.least, size(trial.alpha.back(), trial.beta.back())));
    if (last > dearest * looks.needed) continue;
    if (last <= looks.first) return one_look(last, looks.errors.alpha, looks.errors.beta);
    if (last == looks.needed) return trial;
    return schedule_looks(sizes_up_to(last, count), looks.law, looks.errors);
  }
  return std::nullopt;
}

double log_p_over_looks(const LookSchedule& schedule, std::span<const double> log_p,
                        bool two_sided) {
  check_sizes("log_p_over_looks", schedule.sizes);
  check::at_least({"log_p_over_looks", "looks taken"}, log_p.size(), 1);
  if (log_p.size() > schedule.count()) {
    check::fail({"log_p_over_looks", "looks taken"}, log_p.size(), "at most the number scheduled");
  }
  for (const double each : log_p) check::log_probability({"log_p_over_looks", "log p"}, each);
  if (schedule.law == LookLaw::independent_increments && schedule.count() > 1) {
    return log_p_of_scores(schedule, log_p, two_sided ? std::numbers::ln2 : 0);
  }
  const double smallest = *std::min_element(log_p.begin(), log_p.end());
  if (schedule.law != LookLaw::unknown) return smallest;
  return std::min(0.0, smallest + std::log(static_cast<double>(schedule.count())));
}

}  // namespace assay::stats
