#include "harness/language/law_cdf.h"

#include <boost/math/distributions.hpp>
#include <map>
#include <string>

namespace assay::harness {
namespace {

using Arguments = std::vector<double>;
using Cdf = std::function<double(double)>;

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

const std::map<std::string, Cdf (*)(const Arguments&)>& makers() {
  namespace bm = boost::math;
  static const std::map<std::string, Cdf (*)(const Arguments&)> all{
      {"arcsine", two<bm::arcsine_distribution>},
      {"beta", two<bm::beta_distribution>},
      {"cauchy", two<bm::cauchy_distribution>},
      {"chi_squared", one<bm::chi_squared_distribution>},
      {"exponential", one<bm::exponential_distribution>},
      {"extreme_value", two<bm::extreme_value_distribution>},
      {"fisher_f", two<bm::fisher_f_distribution>},
      {"gamma", two<bm::gamma_distribution>},
      {"inverse_gamma", two<bm::inverse_gamma_distribution>},
      {"inverse_gaussian", two<bm::inverse_gaussian_distribution>},
      {"laplace", two<bm::laplace_distribution>},
      {"logistic", two<bm::logistic_distribution>},
      {"lognormal", two<bm::lognormal_distribution>},
      {"normal", two<bm::normal_distribution>},
      {"pareto", two<bm::pareto_distribution>},
      {"rayleigh", one<bm::rayleigh_distribution>},
      {"student_t", one<bm::students_t_distribution>},
      {"triangular", three<bm::triangular_distribution>},
      {"uniform", two<bm::uniform_distribution>},
      {"weibull", two<bm::weibull_distribution>},
  };
  return all;
}

}  // namespace

std::function<double(double)> law_cdf(const Law& law) {
  return makers().at(law.name)(law.arguments);
}

}  // namespace assay::harness
