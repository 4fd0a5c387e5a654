#include "tests/harness/prelude.h"
// Estimators declare their nature, and the program finds whether it is true.

namespace assay::harness {
namespace {

/// A test of a program that declares `averages`. `observation` makes a number of the list `draws`.
reports::Test judged_declaring(const std::string& law, const std::string& observation, int seed) {
  const Workplace place;
  place.write("mine.py", "import math, sys\nsys.path.append('" ASSAY_SOURCE_DIR
                         R"(/estimators/foreign/python')
import assay
def mine(stream, primaries):
    draws = [)" + law + R"( for _ in range(primaries)]
    return )" + observation + R"(
assay.serve(mine, averages=True)
)");
  const std::string file =
      place.write("mine.yaml",
                  "suite: mine\nestimators:\n  mine: {plugin: process, command: [python3, "
                  "mine.py]}\ntests:\n  - {claim: variance(mine) == 1, secondaries: 500}\n");
  return run_files({file}, {.seed = static_cast<std::uint64_t>(seed)}).suites[0].tests[0];
}

TEST(Declared, AveragesThatIsUntrueIsAnError) {
  for (const char* observation : {"draws[0]", "sum(draws)", "(draws[0] + sum(draws)) / primaries",
                                  "2 * sum(draws[::2]) / primaries"}) {
    const reports::Test test = judged_declaring("stream.gauss(0, 1)", observation, 1);
    expect_said(test, Verdict::error, {"`mine` declares `averages`, but its observations of 8"});
  }
}

TEST(Declared, AveragesThatIsTrueIsNone) {
  for (const char* law : {"stream.gauss(0, 1)", "stream.lognormvariate(0, 2)"}) {
    const reports::Test test = judged_declaring(law, "sum(draws) / primaries", 2);
    EXPECT_NE(test.verdict, Verdict::error) << law << ": " << test.message;
  }
}

}  // namespace
}  // namespace assay::harness
