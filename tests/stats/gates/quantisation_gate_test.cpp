#include "stats/gates/quantisation_gate.h"

#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

std::vector<double> rounded(double steps, std::size_t n, std::uint32_t stream) {
  Philox random(stream);
  return sorted(sample_of(n, [&] { return std::round(random.uniform() * steps) / steps; }));
}

// sum p^2 of 256 equal steps is 1 / 256; rejected at .01 is sqrt(ln(200) / (2 n)).
TEST(QuantisationGate, ValueIsHalfAStepOverTheRejectedDistance) {
  const std::size_t n = 20000;
  const Gate gate = quantisation_gate(rounded(256, n, 1), 0.01);
  const double rejected = std::sqrt(std::log(200) / (2 * static_cast<double>(n)));
  EXPECT_NEAR(gate.value, 1 / 256.0 / (2 * rejected), 0.02 * gate.value);
  EXPECT_EQ(gate.state, GateState::red);
}

TEST(QuantisationGate, LetsFineStepsAndAtomsPass) {
  EXPECT_EQ(quantisation_gate(rounded(1e6, 20000, 2), 0.01).state, GateState::green);
  // An atom among continuous values is a matter of the law, not of rounding.
  Philox random(3);
  const auto atoms = sample_of(2000, [&] { return std::max(0.3, random.uniform()); });
  EXPECT_EQ(quantisation_gate(sorted(atoms), 0.01).value, 0);
}

}  // namespace
}  // namespace assay::stats
