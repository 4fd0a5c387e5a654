#include "harness/language/laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions.hpp>
#include <utility>

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

template <template <class, class> class Distribution, std::size_t... places>
Cdf law_of(const Arguments& a, std::index_sequence<places...>) {
  return cdf_of(Distribution<double, Unpromoted>(a[places]...));
}
template <template <class, class> class Distribution, std::size_t numbers = 2>
Cdf law(const Arguments& a) {
  return law_of<Distribution>(a, std::make_index_sequence<numbers>());
}

}  // namespace

const std::vector<LawInformation>& laws() {
  namespace bm = boost::math;
  static const std::vector<LawInformation> known{
      {"arcsine", {{"low"}, {"high"}}, law<bm::arcsine_distribution>},
      {"beta", {{"alpha", true}, {"beta", true}}, law<bm::beta_distribution>},
      {"cauchy", {{"location"}, {"scale", true}}, law<bm::cauchy_distribution>},
      {"chi_squared", {{"freedom", true}}, law<bm::chi_squared_distribution, 1>},
      {"exponential", {{"rate", true}}, law<bm::exponential_distribution, 1>},
      {"extreme_value", {{"location"}, {"scale", true}}, law<bm::extreme_value_distribution>},
      {"fisher_f", {{"freedom1", true}, {"freedom2", true}}, law<bm::fisher_f_distribution>},
      {"gamma", {{"shape", true}, {"scale", true}}, law<bm::gamma_distribution>},
      {"inverse_gamma", {{"shape", true}, {"scale", true}}, law<bm::inverse_gamma_distribution>},
      {"inverse_gaussian",
       {{"mean", true}, {"scale", true}},
       law<bm::inverse_gaussian_distribution>},
      {"laplace", {{"location"}, {"scale", true}}, law<bm::laplace_distribution>},
      {"logistic", {{"location"}, {"scale", true}}, law<bm::logistic_distribution>},
      {"lognormal", {{"location"}, {"scale", true}}, law<bm::lognormal_distribution>},
      {"normal", {{"mean"}, {"sd", true}}, law<bm::normal_distribution>},
      {"pareto", {{"scale", true}, {"shape", true}}, law<bm::pareto_distribution>},
      {"rayleigh", {{"sigma", true}}, law<bm::rayleigh_distribution, 1>},
      {"student_t", {{"freedom", true}}, law<bm::students_t_distribution, 1>},
      {"triangular", {{"low"}, {"mode"}, {"high"}}, law<bm::triangular_distribution, 3>},
      {"uniform", {{"low"}, {"high"}}, law<bm::uniform_distribution>},
      {"weibull", {{"shape", true}, {"scale", true}}, law<bm::weibull_distribution>},
  };
  return known;
}

const LawInformation* find_law(std::string_view name) {
  const auto found = std::ranges::find(laws(), name, &LawInformation::name);
  return found == laws().end() ? nullptr : &*found;
}

std::string signature(const LawInformation& law) {
  return fmt::format("{}({})", law.name, listed(mapped(law.parameters, &LawParameter::name)));
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
  const bool ascend =
      std::ranges::is_sorted(law.arguments) && law.arguments.front() < law.arguments.back();
  if (interval && !ascend) {
    refuse(law.where, "the numbers of {} must ascend", signature(known));
  }
}

}  // namespace assay::harness
