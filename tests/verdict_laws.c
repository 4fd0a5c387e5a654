/* Laws of many shapes for tests/verdict_study.py: `raw` gives single draws, `average` means of
 * them, `declared` single draws with their range. */
#include <math.h>
#include <string.h>

#include "plugin_abi.h"

static const double pi = 3.14159265358979323846;

static double normal(AssayStream* random) {
  const double u = assay_uniform_open(random);
  const double v = assay_uniform_open(random);
  return sqrt(-2 * log(u)) * cos(2 * pi * v);
}
static double exponential(AssayStream* random) { return -log(assay_uniform_open(random)); }
static double pareto(AssayStream* random, double index) {
  return pow(assay_uniform_open(random), -1 / index);
}
static double student(AssayStream* random, int degrees) {
  const double z = normal(random);
  double sum = 0;
  for (int i = 0; i < degrees; ++i) {
    const double y = normal(random);
    sum += y * y;
  }
  return z / sqrt(sum / degrees);
}
static int happens(AssayStream* random, double probability) {
  return assay_uniform(random) < probability;
}

static double d_normal(AssayStream* r) { return 5 + normal(r); }
static double d_uniform(AssayStream* r) { return assay_uniform(r); }
static double d_exponential(AssayStream* r) { return exponential(r); }
static double d_gamma_half(AssayStream* r) {
  const double z = normal(r);
  return z * z / 2;
}
static double d_gamma_2(AssayStream* r) { return exponential(r) + exponential(r); }
static double d_beta_2_5(AssayStream* r) {
  double least = 2, second = 2;
  for (int i = 0; i < 6; ++i) {
    const double u = assay_uniform(r);
    if (u < least) {
      second = least;
      least = u;
    } else if (u < second) {
      second = u;
    }
  }
  return second;
}
static double d_lognormal_05(AssayStream* r) { return exp(0.5 * normal(r)); }
static double d_lognormal_1(AssayStream* r) { return exp(normal(r)); }
static double d_lognormal_15(AssayStream* r) { return exp(1.5 * normal(r)); }
static double d_lognormal_2(AssayStream* r) { return exp(2 * normal(r)); }
static double d_pareto_15(AssayStream* r) { return pareto(r, 1.5); }
static double d_pareto_21(AssayStream* r) { return pareto(r, 2.1); }
static double d_pareto_3(AssayStream* r) { return pareto(r, 3); }
static double d_pareto_5(AssayStream* r) { return pareto(r, 5); }
static double d_pareto_10(AssayStream* r) { return pareto(r, 10); }
static double d_student_3(AssayStream* r) { return student(r, 3); }
static double d_student_5(AssayStream* r) { return student(r, 5); }
static double d_laplace(AssayStream* r) {
  const double sign = happens(r, 0.5) ? 1 : -1;
  return sign * exponential(r);
}
static double d_logistic(AssayStream* r) {
  const double u = assay_uniform_open(r);
  return log(u / (1 - u));
}
static double d_gumbel(AssayStream* r) { return -log(exponential(r)); }
static double d_weibull_half(AssayStream* r) { return pow(exponential(r), 2); }
static double d_arcsine(AssayStream* r) { return pow(sin(pi / 2 * assay_uniform(r)), 2); }
static double d_triangular(AssayStream* r) { return assay_uniform(r) + assay_uniform(r); }
static double d_rayleigh(AssayStream* r) { return sqrt(2 * exponential(r)); }
static double d_poisson_1(AssayStream* r) {
  double product = assay_uniform_open(r);
  int count = 0;
  for (; product > exp(-1.0); ++count) product *= assay_uniform_open(r);
  return count;
}
static double d_geometric_3(AssayStream* r) { return floor(exponential(r) / -log(0.7)); }
static double d_bernoulli_3(AssayStream* r) { return happens(r, 0.3); }
static double d_bernoulli_01(AssayStream* r) { return happens(r, 0.01); }
static double d_bernoulli_001(AssayStream* r) { return happens(r, 0.001); }
static double d_rare_tenth(AssayStream* r) { return happens(r, 0.1) ? exponential(r) : 0; }
static double d_rare_hundredth(AssayStream* r) { return happens(r, 0.01) ? exponential(r) : 0; }
static double d_spike_hundredth(AssayStream* r) { return happens(r, 0.01) ? 50.5 : 0.5; }
static double d_spike_thousandth(AssayStream* r) { return happens(r, 0.001) ? 500.5 : 0.5; }
static double d_spike_1e4(AssayStream* r) { return happens(r, 1e-4) ? 5000.5 : 0.5; }
static double d_spike_1e5(AssayStream* r) { return happens(r, 1e-5) ? 50000.5 : 0.5; }
static double d_noisy_spike_1e4(AssayStream* r) {
  const double noise = 0.2 * assay_uniform(r);
  return noise + (happens(r, 1e-4) ? 5000.4 : 0.4);
}
static double d_two_lobes(AssayStream* r) {
  const double sign = happens(r, 0.5) ? 1 : -1;
  return 2 * sign + 0.3 * normal(r);
}
static double d_contaminated(AssayStream* r) {
  const double scale = happens(r, 0.01) ? 10 : 1;
  return scale * normal(r);
}
static double d_tenth_power(AssayStream* r) { return pow(assay_uniform(r), 10); }
static double d_firefly(AssayStream* r) {
  const double noise = 0.5 + assay_uniform(r);
  return noise + (happens(r, 0.01) ? pareto(r, 2.5) : 0);
}

typedef double Draw(AssayStream* random);
static const struct {
  const char* name;
  Draw* draw;
  double high; /* the end of the range that begins at 0; else 0 */
} laws[] = {{"normal", d_normal},
            {"uniform", d_uniform, 1},
            {"exponential", d_exponential},
            {"gamma_half", d_gamma_half},
            {"gamma_2", d_gamma_2},
            {"beta_2_5", d_beta_2_5, 1},
            {"lognormal_05", d_lognormal_05},
            {"lognormal_1", d_lognormal_1},
            {"lognormal_15", d_lognormal_15},
            {"lognormal_2", d_lognormal_2},
            {"pareto_15", d_pareto_15},
            {"pareto_21", d_pareto_21},
            {"pareto_3", d_pareto_3},
            {"pareto_5", d_pareto_5},
            {"pareto_10", d_pareto_10},
            {"student_3", d_student_3},
            {"student_5", d_student_5},
            {"laplace", d_laplace},
            {"logistic", d_logistic},
            {"gumbel", d_gumbel},
            {"weibull_half", d_weibull_half},
            {"arcsine", d_arcsine, 1},
            {"triangular", d_triangular, 2},
            {"rayleigh", d_rayleigh},
            {"poisson_1", d_poisson_1},
            {"geometric_3", d_geometric_3},
            {"bernoulli_3", d_bernoulli_3, 1},
            {"bernoulli_01", d_bernoulli_01, 1},
            {"bernoulli_001", d_bernoulli_001, 1},
            {"rare_tenth", d_rare_tenth},
            {"rare_hundredth", d_rare_hundredth},
            {"spike_hundredth", d_spike_hundredth, 50.5},
            {"spike_thousandth", d_spike_thousandth, 500.5},
            {"spike_1e4", d_spike_1e4, 5000.5},
            {"spike_1e5", d_spike_1e5, 50000.5},
            {"noisy_spike_1e4", d_noisy_spike_1e4, 5000.6},
            {"two_lobes", d_two_lobes},
            {"contaminated", d_contaminated},
            {"tenth_power", d_tenth_power, 1},
            {"firefly", d_firefly}};

typedef struct {
  Draw* draw;
  double shift;
  AssayChannel channel;
} Setup;

enum { most_setups = 1024 };
static Setup setups[most_setups];
static int setup_count = 0;

static int prepare(AssayPreparation* preparation) {
  const char* name = assay_value(preparation, 0)->text;
  for (size_t i = 0; i < sizeof laws / sizeof laws[0] && setup_count < most_setups; ++i) {
    if (strcmp(laws[i].name, name) != 0) continue;
    Setup* const setup = &setups[setup_count++];
    setup->draw = laws[i].draw;
    setup->shift = assay_value(preparation, 1)->number;
    setup->channel = *preparation->channels;
    if (setup->channel.flags & ASSAY_HIGH) setup->channel.high = laws[i].high;
    preparation->channels = &setup->channel;
    preparation->setup = setup;
    return 0;
  }
  strncpy(preparation->message, "no such law", preparation->message_size - 1);
  return 1;
}

static int secondary(AssayCall* call) {
  const Setup* const setup = call->setup;
  double sum = 0;
  for (uint64_t i = 0; i < call->primaries; ++i) sum += setup->draw(call->random);
  call->out[0] = setup->shift + sum / (double)call->primaries;
  return 0;
}

static const AssayParameter parameters[] = {
    {.size = sizeof(AssayParameter), .name = "law", .type = ASSAY_TEXT},
    {.size = sizeof(AssayParameter), .name = "shift", .type = ASSAY_NUMBER, .fallback = "0"}};
static const AssayChannel value = {.size = sizeof value, .name = "value"};
static const AssayChannel ranged = {
    .size = sizeof ranged, .name = "value", .flags = ASSAY_LOW | ASSAY_HIGH, .low = 0, .high = 1};
static const AssayEstimator estimators[] = {{.size = sizeof(AssayEstimator),
                                             .name = "average",
                                             .flags = ASSAY_AVERAGES,
                                             .bias = ASSAY_UNBIASED,
                                             .channels = &value,
                                             .channel_count = 1,
                                             .secondary = secondary,
                                             .parameters = parameters,
                                             .parameter_count = 2,
                                             .prepare = prepare},
                                            {.size = sizeof(AssayEstimator),
                                             .name = "raw",
                                             .bias = ASSAY_UNBIASED,
                                             .channels = &value,
                                             .channel_count = 1,
                                             .secondary = secondary,
                                             .parameters = parameters,
                                             .parameter_count = 2,
                                             .prepare = prepare},
                                            {.size = sizeof(AssayEstimator),
                                             .name = "declared",
                                             .bias = ASSAY_UNBIASED,
                                             .channels = &ranged,
                                             .channel_count = 1,
                                             .secondary = secondary,
                                             .parameters = parameters,
                                             .parameter_count = 2,
                                             .prepare = prepare}};
static const AssayLibrary library = {sizeof library, ASSAY_ABI_VERSION, estimators, 3};

const AssayLibrary* assay_library(void) { return &library; }
