#include "stats/means/uncertain_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "stats/basics/check.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

constexpr double share_of_references = 0.1;
constexpr int places_a_reference = 9;
constexpr double precision = 1e-9;  // In ln p.
// Smaller levels, in ln p, are not told apart.
constexpr double smallest_level = -1e9;

using LogP = std::function<double(std::span<const double>)>;

std::vector<double> places(const UncertainReference& reference, double errors) {
  const auto [value, error] = reference.known;
  if (error == 0) return {value};
  std::vector<double> all;
  for (int i = 0; i < places_a_reference; ++i) {
    const double share = 2.0 * i / (places_a_reference - 1) - 1;
    all.push_back(value + share * errors * error);
  }
  all.push_back(std::clamp(reference.turn, all.front(), all[places_a_reference - 1]));
  return all;
}

// The largest ln p over all places of the references from this one on.
double largest(const LogP& log_p, std::span<const UncertainReference> references, double errors,
               std::vector<double>& at) {
  if (at.size() == references.size()) return log_p(at);
  double most = -std::numeric_limits<double>::infinity();
  for (const double place : places(references[at.size()], errors)) {
    at.push_back(place);
    most = std::max(most, largest(log_p, references, errors, at));
    at.pop_back();
  }
  return most;
}

// The largest ln p over the region of the references, at this level of the whole.
double largest_at(const LogP& log_p, std::span<const UncertainReference> references,
                  double log_level) {
  const double log_miss =
      log_level + std::log(share_of_references / 2 / static_cast<double>(references.size()));
  std::vector<double> at;
  return largest(log_p, references, normal_quantile({Tail::upper, log_miss}), at);
}

bool are_exact(std::span<const UncertainReference> references) {
  return std::ranges::all_of(
      references, [](const auto& reference) { return reference.known.standard_error == 0; });
}

}  // namespace

double log_p_over_references(const LogP& log_p, std::span<const UncertainReference> references) {
  std::vector<double> known;
  for (const UncertainReference& reference : references) {
    check::non_negative({"log_p_over_references", "standard error"},
                        reference.known.standard_error);
    known.push_back(reference.known.value);
  }
  const double at_known = log_p(known);
  if (are_exact(references)) return at_known;
  const double for_sample = std::log1p(-share_of_references);
  const auto rejects = [&](double log_level) {
    return largest_at(log_p, references, log_level) <= log_level + for_sample;
  };
  double rejected = 0;
  double kept = std::clamp(at_known - for_sample, smallest_level, 0.0);
  if (!rejects(rejected)) return 0;
  while (rejected - kept > precision * std::max(1.0, -kept)) {
    const double middle = kept + (rejected - kept) / 2;
    (rejects(middle) ? rejected : kept) = middle;
  }
  return rejected;
}

TestResult test_over_references(const std::function<TestResult(std::span<const double>)>& at,
                                std::span<const UncertainReference> references) {
  std::vector<double> known;
  for (const UncertainReference& reference : references) known.push_back(reference.known.value);
  TestResult result = at(known);
  if (are_exact(references)) return result;
  result.log_p_lower = log_p_over_references(
      [&](std::span<const double> values) { return at(values).log_p_lower; }, references);
  result.log_p_upper = log_p_over_references(
      [&](std::span<const double> values) { return at(values).log_p_upper; }, references);
  return result;
}

}  // namespace assay::stats
