// Each function refuses arguments that it cannot take: tests/tables/refused_arguments.txt.

#include "stats/basics/adaptive_quadrature.h"
#include "stats/cells/adaptive_cells.h"
#include "stats/cells/chi_square.h"
#include "stats/gates/assumption_gates.h"
#include "stats/gates/dependence.h"
#include "stats/images/image_equivalence.h"
#include "stats/images/image_moments.h"
#include "stats/laws/kolmogorov_smirnov.h"
#include "stats/laws/quantile_test.h"
#include "stats/means/binomial.h"
#include "stats/means/constant_sample.h"
#include "stats/means/power_exact.h"
#include "stats/means/skewness_corrected_t.h"
#include "stats/means/uncertain_reference.h"
#include "stats/planning/boundary.h"
#include "stats/planning/evidence_ledger.h"
#include "stats/planning/holm.h"
#include "stats/planning/looks.h"
#include "stats/planning/power.h"
#include "stats/pyramids/image_pyramid.h"
#include "stats/tails/kolmogorov.h"
#include "stats/tails/tails.h"
#include "stats/variances/influence.h"
#include "stats/variances/normal_variances.h"
#include "stats/variances/slope.h"
#include "tests/stats/image_samples.h"
#include "tests/stats/point_by_point.h"
#include "tests/stats/prelude.h"

namespace assay::stats::refusals {
namespace {

using Values = std::vector<double>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const Moments x = moments_of(golden_x);
const Moments one = moments_of(Values{1});
const Moments constant = moments_of(Values{1, 1, 1, 1, 1});

/// Lines `call => message` of the table.
std::string expected_of(const std::string& call) {
  std::ifstream file(ASSAY_SOURCE_DIR "/tests/tables/refused_arguments.txt");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(call + " => ")) return line;
  }
  return "not in the table";
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const ZeroVariance& error) {
    return std::string("zero variance: ") + error.what();
  } catch (const std::domain_error& error) {
    // The sign of a number that is none depends on the machine.
    return std::regex_replace(error.what(), std::regex("-nan"), "nan");
  }
  return "nothing was thrown";
}

#define REFUSED(...)                                                                \
  EXPECT_EQ(#__VA_ARGS__ " => " + refusal([&] { static_cast<void>(__VA_ARGS__); }), \
            expected_of(#__VA_ARGS__))

TEST(Refusals, OfBasics) {
  REFUSED(one.variance());
  REFUSED(constant.skewness());
  REFUSED(constant.kurtosis());
}

TEST(Refusals, OfCells) {
  const PlaneGrid grid = unit_grid(2, 2);
  const PlaneGrid backwards{{0, 1}, {1, 0}};
  const PlaneDensity flat = on_unit_square([](double, double) { return 1.0; });
  const PlaneDensity undefined = on_unit_square([](double, double) { return nan; });
  REFUSED(adaptive_cells(grid, undefined, 1));
  REFUSED(adaptive_cells(grid, flat, 0));
  REFUSED(adaptive_cells(grid, flat, 1.5));
  REFUSED(adaptive_cells(backwards, flat, 1));
  REFUSED(grid.index(0, nan));
  const std::vector<PooledCell> too_few{{1, 1, {}}, {2, 2, {}}};
  REFUSED(CellEffect(too_few, 3));
  REFUSED(chi_square_fit({{1}, {.5, .5}}));
  REFUSED(chi_square_fit({{}, {}}));
  REFUSED(chi_square_fit({{50, 50}, {.5, .4}}));
  REFUSED(chi_square_fit({{50, 50}, {.5, nan}}));
  REFUSED(chi_square_fit({{0, 0}, {.5, .5}}));
  REFUSED(chi_square_fit({{5, 5}, {.5, .5}}));
  REFUSED(chi_square_two_sample({{1, 2}, {1}}));
  REFUSED(chi_square_two_sample({{}, {}}));
  REFUSED(chi_square_two_sample({{0, 0}, {100, 100}}));
  REFUSED(chi_square_two_sample({{50, 50}, {160, 840}}));
  REFUSED(sampled_cells({}, {}));
  REFUSED(sampled_cells({{nan, 0}}, {}));
  REFUSED(sampled_cells({{0, 0}}, {.bands = 0}));
}

TEST(Refusals, OfGates) {
  const Values values{1, 2, 3, 5, 8, 13};
  const Values same(20, 3.0);
  REFUSED(skewness_gate(constant, 3));
  REFUSED(dominance_gate(constant));
  REFUSED(effective_observations_gate({&constant, 1}));
  REFUSED(effective_observations_gate(std::vector{constant, constant}));
  REFUSED(kurtosis_gate(constant));
  REFUSED(skewness_gate(x, -1));
  REFUSED(primaries_for_variance(nan));
  REFUSED(averages_gate(values, values, 0));
  REFUSED(averages_gate(Values(600, 1.0), Values(16, nan), 32));
  REFUSED(autocorrelation(values, 6));
  REFUSED(autocorrelation(same, 1));
  REFUSED(lag_one_test(Values{1, 2, 3}));
  REFUSED(lag_one_test(Values{1, 2, 3, nan}));
  REFUSED(effective_sample_size(same));
  REFUSED(batch_means(values, 0));
  REFUSED(batch_means(values, 4));
  REFUSED(batch_gate(values));
  REFUSED(batch_gate(same));
  REFUSED(lag_one_gate(same));
  REFUSED(quantisation_gate(Values{1}, 0.01));
}

TEST(Refusals, OfLaws) {
  const Values good{1, 2};
  const Values falling{2, 1};
  const Values with_nan{1, nan};
  const ContinuousLaw exponential{[](double v) { return -std::expm1(-v); }};
  const ContinuousLaw beyond{[](double v) { return v; }};
  const OneSampleDistance distance{.1, 5};
  REFUSED(ks_distance(Values{}, exponential));
  REFUSED(ks_distance(falling, exponential));
  REFUSED(ks_distance(Values{nan}, exponential));
  REFUSED(ks_distance(Values{1, infinity}, exponential));
  REFUSED(ks_distance(good, falling));
  REFUSED(ks_distance(good, Values{1, infinity}));
  REFUSED(ks_distance(good, beyond));
  REFUSED(ks_margin(distance, 1));
  REFUSED(quantile_test({0, 0, 0}, .5));
  REFUSED(quantile_test({5, 4, 9}, .5));
  REFUSED(quantile_test({5, 10, 9}, .5));
  REFUSED(quantile_test({1, 1, 2}, 1));
  REFUSED(count_around(falling, 1));
  REFUSED(count_around(with_nan, 1));
  REFUSED(quantile_interval({}, .5, .9));
  REFUSED(quantile_compare(falling, falling, .5));
  REFUSED(quantile_compare(good, good, .5, infinity));
  REFUSED(sample_quantile_rank(0, 0.5));
}

TEST(Refusals, OfMeans) {
  REFUSED(student_t(one, {0}));
  REFUSED(student_t(constant, {0}));
  REFUSED(student_t(x, {nan}));
  REFUSED(student_t(x, {0, -1}));
  REFUSED(student_t_interval(x, {0}, nan));
  REFUSED(welch_t(constant, constant, {}));
  REFUSED(welch_t(x, one, {}));
  REFUSED(welch_t(x, x, {nan, 0}));
  REFUSED(welch_t(x, x, {1, nan}));
  REFUSED(interval_by_inversion({}, {}, 0));
  REFUSED(skewness_corrected_t(constant, {0}));
  REFUSED(skewness_corrected_welch(x, x, {1, nan}));
  REFUSED(skewness_corrected_welch(constant, constant, {}));
  REFUSED(residual_skewness_gate(x, {0}, 0));
  EXPECT_NO_THROW(skewness_corrected_welch(x, constant, {}));
  const ValueCells cells(Values{.1, .9});
  REFUSED(betting_mean(cells, {0, .5}, .3));
  REFUSED(betting_mean(cells, {.5, 1}, .3));
  REFUSED(betting_mean(cells, {0, nan}, .3));
  REFUSED(betting_mean(cells, {0, 1}, nan));
  REFUSED(betting_contrast(cells, {0, 1}, cells, {0, 1}, {nan, .3}));
  REFUSED(ValueCells(Values{}));
  REFUSED(ValueCells(Values{1, infinity}));
  REFUSED(binomial({0, 0}, .5));
  REFUSED(binomial({3, 2}, .5));
  REFUSED(binomial({1, 2}, 1.5));
  REFUSED(clopper_pearson({1, 2}, 1));
  REFUSED(log_p_constant({0, 0, 1, 0}, {0, 0}));
  REFUSED(log_p_constant({2, 0, 1, 5}, {0, 0}));
  REFUSED(log_p_constant({0, 0, 1, 5}, {nan, 0}));
  REFUSED(log_p_constant({0, 0, 1, 5}, {0, -1}));
  const ExactMeanPlan coin{.range = {0, 1}, .null_mean = 0.5, .rates = {.05, .1, true}};
  REFUSED(binomial_planning.power(coin, 0, 0.1));
  REFUSED(binomial_planning.power(coin, 10, 0));
  REFUSED(betting_planning.power(coin, 0, 0.1));
  const TwoValued hits{{0, 1}, {3, 10}};
  const TwoValued impossible{{0, 1}, {4, 3}};
  const TwoValued none{{0, 1}, {0, 0}};
  const TwoValued point{{1, 1}, {0, 1}};
  REFUSED(two_valued(moments_of(Values{0, 1, 1}), {0, .9}));
  REFUSED(two_valued(moments_of(Values{0, .5, 1}), {0, 1}));
  REFUSED(two_valued_contrast(hits, hits, {infinity, 0}));
  REFUSED(two_valued_contrast(hits, hits, {1, nan}));
  REFUSED(two_valued_contrast(hits, impossible, {}));
  REFUSED(two_valued_mean(none, .5));
  REFUSED(two_valued_mean(point, 1));
  REFUSED(two_valued_difference_interval(hits, hits, 0));
  const std::array negative{UncertainReference{.known = {7, -1}}};
  REFUSED(log_p_over_references([](std::span<const double>) { return 0.0; }, negative));
}

TEST(Refusals, OfPlanning) {
  constexpr ErrorRates rates{.alpha = .01, .beta = .02, .two_sided = true};
  REFUSED(WangTsiatis({}));
  REFUSED(WangTsiatis(Values{0, 1}));
  REFUSED(WangTsiatis(Values{1, 1}));
  REFUSED(WangTsiatis(Values{1}, .6));
  const WangTsiatis boundary(Values{1, 2});
  REFUSED(boundary.constant(1));
  REFUSED(boundary.log_crossing(nan));
  const std::vector<StoppingLook> crossed{{.below = 1, .above = 0}};
  REFUSED(stop_probabilities({}));
  REFUSED(stop_probabilities(crossed));
  REFUSED(stop_probabilities(std::vector<StoppingLook>{{}}, nan));
  PooledNights nights;
  REFUSED(nights.add({1, -1, 1}));
  REFUSED(nights.add({nan, 1, 1}));
  REFUSED(nights.add({1, 1, 0}));
  REFUSED(nights.add({1, 1, 1, .9}));
  REFUSED(PooledPValues().add(.1));
  REFUSED(log_e_value(nights, {.reference_error = -1}));
  REFUSED(change_point(std::vector<NightEstimate>(), {}));
  REFUSED(first_alarm({}, 0));
  REFUSED(weighted_holm(std::vector<WeightedLogP>{{nan, 1}}));
  REFUSED(weighted_holm(std::vector<WeightedLogP>{{-1, 0}}));
  REFUSED(weighted_holm(std::vector<WeightedLogP>{{-1, .6}, {-1, .5}}));
  REFUSED(geometric_sizes({0, 4}, 2));
  REFUSED(geometric_sizes({5, 4}, 2));
  REFUSED(geometric_sizes({1, 4}, nan));
  REFUSED(schedule_looks({}, LookLaw::unknown, rates));
  REFUSED(schedule_looks({2, 1}, LookLaw::unknown, rates));
  REFUSED(schedule_looks({1}, LookLaw::unknown, {.alpha = 0}));
  const LookSchedule look = schedule_looks({1}, LookLaw::unknown, rates);
  REFUSED(log_p_over_looks(look, {}, true));
  REFUSED(log_p_over_looks(look, Values{-1, -1}, true));
  REFUSED(log_p_over_looks(look, Values{nan}, true));
  REFUSED(student_t_power({.rates = {0, .1, true}}, 10, 1));
  REFUSED(student_t_power({.standard_deviation = 0}, 10, 1));
  REFUSED(student_t_power({}, 1, 1));
  REFUSED(student_t_sample_size({.allow = .2}, .1));
  REFUSED(ks_sample_size({}, 0));
  REFUSED(chi_square_fit_power({.degrees_of_freedom = 0}, 10, 1));
}

TEST(Refusals, OfTails) {
  REFUSED(kolmogorov_tails(.5, 0));
  REFUSED(kolmogorov_tails(nan, 5));
  REFUSED(kolmogorov_upper_quantile(0, 5));
  REFUSED(smirnov_upper_tail({1, 3, 4}, std::vector<TiedRun>{{5, 3}}));
  REFUSED(smirnov_upper_tail({1, 3, 4}, std::vector<TiedRun>{{2, 3}, {4, 2}}));
  REFUSED(smirnov_upper_tail({1, 0, 4}));
  REFUSED(smirnov_upper_tail({1, 1ULL << 40, (1ULL << 40) - 1}));
  AdaptiveQuadrature rule({});
  const auto nothing = rule.of([](double) { return 0.0; });
  REFUSED(tabulate(nothing, cut({0, 1}, {0, 1}, {32}), rule));
  for (const double bad : {nan, infinity, -infinity}) {
    EXPECT_THROW(normal_tails(bad), std::domain_error);
    EXPECT_THROW(student_t_tails(bad, 3), std::domain_error);
    EXPECT_THROW(student_t_tails(1, bad), std::domain_error);
    EXPECT_THROW(chi_square_tails(bad, 3), std::domain_error);
    EXPECT_THROW(f_tails(1, {bad, 3}), std::domain_error);
    EXPECT_THROW(noncentral_t_tails(1, {3, bad}), std::domain_error);
    EXPECT_THROW(noncentral_chi_square_tails(1, {3, bad}), std::domain_error);
    EXPECT_THROW(normal_quantile({Tail::lower, bad}), std::domain_error);
    EXPECT_THROW(beta_tails(bad, {1, 1}), std::domain_error);
  }
  REFUSED(student_t_tails(1, 0));
  REFUSED(normal_quantile({Tail::lower, 0}));
  REFUSED(binomial_tails(3, {2, 0.5}));
}

TEST(Refusals, OfVariances) {
  REFUSED(chi_square_variance(constant, 1));
  REFUSED(f_ratio(x, constant, 1));
  REFUSED(f_ratio(constant, x, 1));
  for (const double bad : {0.0, -1.0, nan, infinity}) {
    EXPECT_THROW(chi_square_variance(x, bad), std::domain_error);
    EXPECT_THROW(f_ratio(x, x, bad), std::domain_error);
    EXPECT_THROW(log_variance_evidence(x, {}, 1).interval(bad), std::domain_error);
  }
  const auto joint = [](const Values& values, double cost = 1) {
    return tests::joint({values, Values(values.size(), cost)});
  };
  REFUSED(influence_of_variance(joint({2, 2, 2, 2, 2})));
  REFUSED(influence_of_error_and_cost(joint({2, 2, 2, 2, 2}), 1));
  REFUSED(influence_of_variance(joint({1, 2, 3})));
  REFUSED(influence_of_variance_and_cost(joint(golden_x, 0)));
  REFUSED(influence_of_variance(joint({1e50, -1e50, 2e50, 0})));
  REFUSED(influence_of_variance(joint({1e-50, -1e-50, 2e-50, 0})));
  REFUSED(influence_of_mean(moments_of(Values{-1, 0})));
  REFUSED(influence_t(influence_of_variance(joint(golden_x)), nan));
  REFUSED(slope_test({{{8, 1, 1}}}, -1));
  REFUSED(slope_test({{{8, 1, 1}, {8, 1, 1}}}, -1));
  REFUSED(slope_test({{{0, 1, 1}, {8, 1, 1}}}, -1));
  REFUSED(slope_test({{{1, 1, 0}, {8, 1, 1}}}, -1));
  REFUSED(slope_test({{{1, nan, 1}, {8, 1, 1}}}, -1));
  REFUSED(slope_test({{{1, 1, 1}, {8, 1, 1}}, -1}, -1));
  REFUSED(slope_test({{{1, 1, 1}, {8, 1, 1}}}, nan));
  REFUSED(slope_set({{{1, 1, 1}, {8, 1, 1}}}, 1));
}

TEST(Refusals, OfImages) {
  constexpr ImageExtent extent{12, 10, 1};
  Philox random(842);
  const auto draw = [&](std::size_t) { return random.normal(); };
  const OwnedStack stack = draw_stack(extent, 16, draw);
  const OwnedStack few = draw_stack(extent, 15, draw);
  const OwnedStack still = draw_stack(extent, 16, [](std::size_t) { return 1; });
  OwnedStack infinite = stack;
  infinite.images[3][5] = std::numeric_limits<float>::infinity();
  const ImageDistance no_distance = image_distance({still.view(), still.view()});
  Values short_of_one(extent.elements() - 1);
  const std::vector<float> image(3);
  std::vector<Moments> moments(3);
  const ImageStack empty{{3, 1, 1}, {}};
  const ImageStack whole{{3, 1, 1}, {image}};
  REFUSED(image_pyramid({stack.view(), few.view()}));
  REFUSED(image_pyramid({stack.view(), stack.view()}, {.z = short_of_one}));
  REFUSED(image_pyramid({infinite.view(), stack.view()}));
  REFUSED(squared_margin_test(no_distance, .01));
  REFUSED(image_distance({stack.view(), few.view()}));
  REFUSED(element_moments(empty, 0, moments));
  REFUSED(element_moments(whole, 1, moments));
}

}  // namespace
}  // namespace assay::stats::refusals
