/* The area of the unit disc by darts, as a library for Assay's plugin `library`. */
#include "plugin_abi.h"

static int secondary(AssayCall *call) {
  uint64_t hits = 0;
  for (uint64_t i = 0; i < call->primaries; ++i) {
    double u = 2 * assay_uniform(call->random) - 1;
    double v = 2 * assay_uniform(call->random) - 1;
    hits += u * u + v * v < 1;
  }
  call->out[0] = 4 * (double)hits / (double)call->primaries;
  return 0;
}

static const AssayChannel area = {
    .size = sizeof area, .name = "area", .flags = ASSAY_LOW | ASSAY_HIGH, .low = 0, .high = 4};
static const AssayEstimator darts = {.size = sizeof darts,
                                     .name = "darts",
                                     .flags = ASSAY_AVERAGES,
                                     .bias = ASSAY_UNBIASED,
                                     .channels = &area,
                                     .channel_count = 1,
                                     .secondary = secondary};
static const AssayLibrary library = {sizeof library, ASSAY_ABI_VERSION, &darts, 1};

const AssayLibrary *assay_library(void) { return &library; }
