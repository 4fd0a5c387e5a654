#include <algorithm>
#include <cmath>

#include "stats/means/skewness_corrected_t.h"
#include "stats/planning/planning.h"

namespace assay::stats {
namespace {

using planning::critical_tail;

struct Studentised {
  double standard_error;
  double degrees;
  double a;  // The skewness of the estimate over 6.
};

// P(reject), null region |theta| <= allow or theta <= allow.
class Power {
 public:
  Power(const Studentised& scale, const ErrorRates& rates)
      : scale_(scale),
        rates_(rates),
        critical_(student_t_quantile(critical_tail(rates), scale.degrees)) {}

  // The far side is the near one of the mirrored estimate.
  double at(EffectPlan effect) const {
    const double near = tail(effect.detect - effect.allow, scale_.a);
    const double far = rates_.two_sided ? tail(-effect.detect - effect.allow, -scale_.a) : 0;
    return std::min(near + far, 1.0);
  }

 private:
  // P(T and T_H exceed the critical value) of an effect. It is monotone in the noncentrality, and 1
  // to the last digit a hundred critical values away. Farther out only rounding is left of the
  // integrals.
  double tail(double effect, double a) const {
    const double most = 100 * std::max(1.0, std::abs(critical_));
    const double t = std::clamp(effect / scale_.standard_error, -most, most);
    const double noncentrality = std::clamp(without_skewness(t, a) - a, -most, most);
    const double both = std::max(critical_, without_skewness(critical_, a));
    return std::exp(noncentral_t_tails(both, {scale_.degrees, noncentrality}).upper);
  }

  Studentised scale_;
  ErrorRates rates_;
  double critical_;
};

Studentised scale_of(const MeanPlan& plan, double n) {
  const double other_n = n * plan.allocation;
  const double own = plan.standard_deviation * plan.standard_deviation / n;
  const double other = plan.other_standard_deviation * plan.other_standard_deviation / other_n;
  const double total = own + other + plan.reference_standard_error * plan.reference_standard_error;
  const double part = own / total;
  const double other_part = other / total;
  return {std::sqrt(total),
          (n - 1) / (part * part + other_part * other_part * (n - 1) / (other_n - 1)),
          (plan.skewness * part * std::sqrt(part / n) +
           plan.other_skewness * other_part * std::sqrt(other_part / other_n)) /
              6};
}

void check_plan(const char* function, const MeanPlan& plan) {
  planning::check_rates(function, plan.rates);
  check::non_negative({function, "other_standard_deviation"}, plan.other_standard_deviation);
  if (plan.other_standard_deviation == 0) {
    check::positive({function, "standard_deviation"}, plan.standard_deviation);
  }
  check::non_negative({function, "standard_deviation"}, plan.standard_deviation);
  check::positive({function, "allocation"}, plan.allocation);
  check::finite({function, "skewness"}, plan.skewness);
  check::finite({function, "other_skewness"}, plan.other_skewness);
  check::non_negative({function, "allow"}, plan.allow);
  check::non_negative({function, "reference_standard_error"}, plan.reference_standard_error);
}

void check_size(const char* function, double n) {
  if (!(n > 1) || !std::isfinite(n)) check::fail({function, "n"}, n, "above 1 and finite");
}

double z_sum(const ErrorRates& rates) {
  return normal_quantile(critical_tail(rates)) + upper_normal_quantile(rates.beta);
}

}  // namespace

double planned_variance(const Moments& pilot) {
  constexpr double elasticity = 6.5;
  const double n = static_cast<double>(pilot.count);
  const double spread = std::max(0.0, pilot.kurtosis() - 1) / n;
  return pilot.variance() * std::exp(elasticity / 2 * spread);
}

double normal_sample_size(double standard_deviation, EffectPlan effect, ErrorRates rates) {
  planning::check_rates("normal_sample_size", rates);
  planning::check_effect("normal_sample_size", effect.allow, effect.detect);
  check::positive({"normal_sample_size", "standard_deviation"}, standard_deviation);
  const double ratio = z_sum(rates) * standard_deviation / (effect.detect - effect.allow);
  return ratio * ratio;
}

double student_t_power(const MeanPlan& plan, double n, double effect) {
  check_plan("student_t_power", plan);
  check_size("student_t_power", std::min(n, n * plan.allocation));
  check::finite({"student_t_power", "effect"}, effect);
  return Power(scale_of(plan, n), plan.rates).at({plan.allow, effect});
}

double student_t_detectable(const MeanPlan& plan, double n) {
  check_plan("student_t_detectable", plan);
  check_size("student_t_detectable", std::min(n, n * plan.allocation));
  const Studentised scale = scale_of(plan, n);
  const Power power(scale, plan.rates);
  return planning::smallest_effect(
      [&](double effect) {
        return power.at({plan.allow, effect});
      },
      1 - plan.rates.beta, plan.allow, scale.standard_error);
}

std::optional<std::uint64_t> student_t_sample_size(const MeanPlan& plan, double detect) {
  check_plan("student_t_sample_size", plan);
  planning::check_effect("student_t_sample_size", plan.allow, detect);
  // With ever more samples only the reference's own error is left.
  const double gap = detect - plan.allow;
  const double attainable = gap / z_sum(plan.rates);
  const double left =
      attainable * attainable - plan.reference_standard_error * plan.reference_standard_error;
  if (left <= 0) return std::nullopt;
  const double spread = std::hypot(plan.standard_deviation,
                                   plan.other_standard_deviation / std::sqrt(plan.allocation));
  const double guess = spread * spread / left;
  if (guess > planning::most_samples) return std::nullopt;
  const auto enough = [&](double n) {
    return Power(scale_of(plan, n), plan.rates).at({plan.allow, detect}) >= 1 - plan.rates.beta;
  };
  const double minimum = std::max(2.0, std::ceil(2 / plan.allocation));
  // t needs z_alpha^2 / 2 beyond the normal formula (Guenther 1981), nearly exact.
  const double z = normal_quantile(critical_tail(plan.rates));
  return planning::smallest_sample(enough, guess + z * z / 2, minimum);
}

}  // namespace assay::stats
