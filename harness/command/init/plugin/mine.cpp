// Irradiance from a sky of radiance 1 + cos(theta), by two densities of directions. It is 5 pi / 3.
#include <plugin_abi.h>

#include <cmath>
#include <iterator>

namespace {

constexpr double pi = 3.14159265358979323846;

// One sample f / p. Put your own estimator here; `random` gives its random numbers.
double uniform_direction(AssayStream* random) {
  const double cosine = assay_uniform(random);  // p = 1 / (2 pi)
  return (1 + cosine) * cosine * 2 * pi;
}

double cosine_direction(AssayStream* random) {
  const double cosine = std::sqrt(assay_uniform(random));  // p = cosine / pi
  return (1 + cosine) * pi;
}

// One observation: the mean of as many samples as Assay asks for.
template <double (*sample)(AssayStream*)>
int observation(AssayCall* call) {
  double sum = 0;
  for (uint64_t i = 0; i < call->primaries; ++i) sum += sample(call->random);
  call->out[0] = sum / static_cast<double>(call->primaries);
  return 0;
}

const AssayChannel irradiance{.size = sizeof irradiance, .name = "irradiance"};

template <double (*sample)(AssayStream*)>
AssayEstimator estimator(const char* name) {
  AssayEstimator made{};
  made.size = sizeof made;
  made.name = name;
  made.flags = ASSAY_AVERAGES;
  made.bias = ASSAY_UNBIASED;
  made.channels = &irradiance;
  made.channel_count = 1;
  made.secondary = observation<sample>;
  return made;
}

const AssayEstimator estimators[] = {estimator<uniform_direction>("uniform"),
                                     estimator<cosine_direction>("cosine")};
const AssayLibrary library{sizeof library, ASSAY_ABI_VERSION, estimators, std::size(estimators)};

}  // namespace

const AssayLibrary* assay_library() { return &library; }
