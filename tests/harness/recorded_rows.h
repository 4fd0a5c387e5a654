#pragma once

// Rows of a file, made here, and what one test says of them.

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/harness/running.h"
#include "tests/philox.h"

namespace assay::harness {

using tests::Philox;

using Draw = std::function<double(Philox&)>;

inline std::string file_of(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{}\n", value);
  return text;
}

inline std::vector<double> rows_of(std::size_t count, std::uint32_t stream, const Draw& draw) {
  Philox random(stream);
  std::vector<double> values(count);
  for (double& value : values) value = draw(random);
  return values;
}

inline reports::Test judged(const std::vector<double>& values, const std::string& test,
                            double alpha = 0.01) {
  const Workplace place;
  place.write("rows.txt", file_of(values));
  const std::string text = fmt::format(
      "suite: rows\nalpha: {}\nestimators:\n  rows: {{plugin: recorded, file: rows.txt}}\n"
      "tests:\n  - {{{}}}\n",
      alpha, test);
  return run_files({place.write("suite.yaml", text)}).suites[0].tests[0];
}

inline double normal(Philox& random) { return random.normal(); }

/// An AR(1) chain of unit variance in equilibrium.
inline std::vector<double> chain(double phi, std::size_t count, std::uint32_t stream) {
  Philox random(stream);
  double x = random.normal();
  return rows_of(count, stream + 1000, [&](Philox& next) {
    x = phi * x + std::sqrt(1 - phi * phi) * next.normal();
    return x;
  });
}

}  // namespace assay::harness
