#include "harness/language/laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions.hpp>

namespace assay::harness {
namespace {

using Cdf = std::function<double(double)>;
using Arguments = std::vector<double>;

/// Boost throws outside the support, where the function is 0 or 1.
template <class Distribution>
Cdf cdf_of(const Distribution& distribution) {
  const auto support = boost::math::support(distribution);
  return [distribution, support](double x) {
    if (x <= support.first) return 0.0;
    if (x >= support.second) return 1.0;
    return static_cast<double>(boost::math::cdf(distribution, x));
  };
}

// Doubles, not long doubles: a distance needs no more than ten digits, and this is faster.
using Unpromoted = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

template <template <class, class> class Distribution>
Cdf one(const Arguments& a) {
  return cdf_of(Distribution<double, Unpromoted>(a[0]));
}
template <template <class, class> class Distribution>
Cdf two(const Arguments& a) {
  return cdf_of(Distribution<double, Unpromoted>(a[0], a[1]));
}
template <template <class, class> class Distribution>
Cdf three(const Arguments& a) {
  return cdf_of(Distribution<double, Unpromoted>(a[0], a[1], a[2]));
}

}  // namespace

const std::vector<LawInformation>& laws() {
  namespace bm = boost::math;
  static const std::vector<LawInformation> known{
      {"arcsine", {{"low"}, {"high"}}, two<bm::arcsine_distribution>},
      {"beta", {{"alpha", true}, {"beta", true}}, two<bm::beta_distribution>},
      {"cauchy", {{"location"}, {"scale", true}}, two<bm::cauchy_distribution>},
      {"chi_squared", {{"freedom", true}}, one<bm::chi_squared_distribution>},
      {"exponential", {{"rate", true}}, one<bm::exponential_distribution>},
      {"extreme_value", {{"location"}, {"scale", true}}, two<bm::extreme_value_distribution>},
      {"fisher_f", {{"freedom1", true}, {"freedom2", true}}, two<bm::fisher_f_distribution>},
      {"gamma", {{"shape", true}, {"scale", true}}, two<bm::gamma_distribution>},
      {"inverse_gamma", {{"shape", true}, {"scale", true}}, two<bm::inverse_gamma_distribution>},
      {"inverse_gaussian",
       {{"mean", true}, {"scale", true}},
       two<bm::inverse_gaussian_distribution>},
      {"laplace", {{"location"}, {"scale", true}}, two<bm::laplace_distribution>},
      {"logistic", {{"location"}, {"scale", true}}, two<bm::logistic_distribution>},
      {"lognormal", {{"location"}, {"scale", true}}, two<bm::lognormal_distribution>},
      {"normal", {{"mean"}, {"sd", true}}, two<bm::normal_distribution>},
      {"pareto", {{"scale", true}, {"shape", true}}, two<bm::pareto_distribution>},
      {"rayleigh", {{"sigma", true}}, one<bm::rayleigh_distribution>},
      {"student_t", {{"freedom", true}}, one<bm::students_t_distribution>},
      {"triangular", {{"low"}, {"mode"}, {"high"}}, three<bm::triangular_distribution>},
      {"uniform", {{"low"}, {"high"}}, two<bm::uniform_distribution>},
      {"weibull", {{"shape", true}, {"scale", true}}, two<bm::weibull_distribution>},
  };
  return known;
}

const LawInformation* find_law(std::string_view name) {
  const auto found = std::ranges::find(laws(), name, &LawInformation::name);
  return found == laws().end() ? nullptr : &*found;
}

std::string signature(const LawInformation& law) {
  return fmt::format("{}({})", law.name, listed(names_of(law.parameters, &LawParameter::name)));
}

void check_law(const Law& law) {
  const LawInformation& known = *find_law(law.name);
  if (law.arguments.size() != known.parameters.size()) {
    refuse(law.where, "`{}` has {} of its numbers; write {}", law.name, law.arguments.size(),
           signature(known));
  }
  for (std::size_t i = 0; i < law.arguments.size(); ++i) {
    if (known.parameters[i].positive && !(law.arguments[i] > 0)) {
      refuse(law.where, "`{}` of {} must be above 0, but it is {}", known.parameters[i].name,
             signature(known), law.arguments[i]);
    }
  }
  const bool interval = known.parameters.front().name == "low";
  if (interval && !std::ranges::is_sorted(law.arguments)) {
    refuse(law.where, "the numbers of {} must ascend", signature(known));
  }
  if (interval && law.arguments.front() == law.arguments.back()) {
    refuse(law.where, "{} with equal ends has no density", signature(known));
  }
}

std::function<double(double)> law_cdf(const Law& law) {
  return find_law(law.name)->cdf(law.arguments);
}

}  // namespace assay::harness
