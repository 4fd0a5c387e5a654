#pragma once

// Every test of this folder includes this: tests/prelude.h, property tests, and records.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "reports/words/display.h"
#include "tests/prelude.h"
#include "tests/reports/example_record.h"
#include "tests/reports/random_record.h"

namespace assay::tests {

inline std::vector<std::string> lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> all;
  for (std::string line; std::getline(stream, line);) all.push_back(line);
  return all;
}

}  // namespace assay::tests
