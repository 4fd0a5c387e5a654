// Mutants of path termination whose bias has no closed form; families_test.cpp has the others.

#include "tests/estimators/draws.h"
#include "tests/prelude.h"

namespace assay {
namespace {

constexpr std::uint64_t observations = 1u << 14;

// A tenth and more of each channel is 0 for long: means of 16 primaries are near normal.
constexpr std::uint64_t primaries = 16;

struct Caught {
  const char* mutant;
  std::string parameters;
};

void PrintTo(const Caught& caught, std::ostream* out) { *out << caught.mutant; }

class CaughtMutants : public testing::TestWithParam<Caught> {};

// Each channel is off by more than a standard normal would be with probability 1e-6, and by a
// tenth.
TEST_P(CaughtMutants, MissEveryChannel) {
  const draws::Prepared plugin = draws::prepare(GetParam().mutant, GetParam().parameters);
  const auto samples = draws::observe(plugin, observations, primaries);
  const std::vector<Channel> channels = plugin.setup->channels();
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].diagnostic) continue;
    const double off = std::abs(samples[c].mean() - channels[c].mean.value());
    EXPECT_GT(off, draws::five * samples[c].mean_error()) << channels[c].name;
    EXPECT_GT(off, 0.1 * *channels[c].mean) << channels[c].name;
  }
}

const std::string by_throughput = "{scene: coloured_sphere, rule: throughput}";

INSTANTIATE_TEST_SUITE_P(Table, CaughtMutants,
                         testing::Values(Caught{"mutants/clamped_survival", by_throughput},
                                         Caught{"mutants/luminance_throughput", by_throughput},
                                         Caught{"mutants/survival_after_update", by_throughput},
                                         Caught{"mutants/drawn_number", "{scene: sphere}"},
                                         Caught{"mutants/split_while_bright", "{scene: sphere}"},
                                         Caught{"mutants/number_from_first_child",
                                                "{scene: sphere}"}));

}  // namespace
}  // namespace assay
