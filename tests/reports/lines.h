#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace assay::tests {

inline std::vector<std::string> lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> all;
  for (std::string line; std::getline(stream, line);) all.push_back(line);
  return all;
}

}  // namespace assay::tests
