#include "harness/law_cdf.h"

#include <boost/math/distributions.hpp>
#include <map>
#include <string>

namespace assay::harness {
namespace {

using Arguments = std::vector<double>;
using Cdf = std::function<double(double)>;

/// Boost throws outside the support; there the function is 0 or 1.
template <class Distribution>
Cdf cdf_of(const Distribution& distribution) {
  const auto support = boost::math::support(distribution);
  return [distribution, support](double x) {
    if (x <= support.first) return 0.0;
    if (x >= support.second) return 1.0;
    return static_cast<double>(boost::math::cdf(distribution, x));
  };
}

template <class Distribution>
Cdf one(const Arguments& a) {
  return cdf_of(Distribution(a[0]));
}
template <class Distribution>
Cdf two(const Arguments& a) {
  return cdf_of(Distribution(a[0], a[1]));
}
template <class Distribution>
Cdf three(const Arguments& a) {
  return cdf_of(Distribution(a[0], a[1], a[2]));
}

const std::map<std::string, Cdf (*)(const Arguments&)>& makers() {
  namespace bm = boost::math;
  static const std::map<std::string, Cdf (*)(const Arguments&)> all{
      {"arcsine", two<bm::arcsine>},
      {"beta", two<bm::beta_distribution<>>},
      {"cauchy", two<bm::cauchy>},
      {"chi_squared", one<bm::chi_squared>},
      {"exponential", one<bm::exponential>},
      {"extreme_value", two<bm::extreme_value>},
      {"fisher_f", two<bm::fisher_f>},
      {"gamma", two<bm::gamma_distribution<>>},
      {"inverse_gamma", two<bm::inverse_gamma_distribution<>>},
      {"inverse_gaussian", two<bm::inverse_gaussian>},
      {"laplace", two<bm::laplace>},
      {"logistic", two<bm::logistic>},
      {"lognormal", two<bm::lognormal>},
      {"normal", two<bm::normal>},
      {"pareto", two<bm::pareto>},
      {"rayleigh", one<bm::rayleigh>},
      {"student_t", one<bm::students_t>},
      {"triangular", three<bm::triangular>},
      {"uniform", two<bm::uniform>},
      {"weibull", two<bm::weibull>},
  };
  return all;
}

}  // namespace

std::function<double(double)> law_cdf(const Law& law) {
  return makers().at(law.name)(law.arguments);
}

}  // namespace assay::harness
