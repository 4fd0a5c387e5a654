#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace assay::tests {

/// The rows of tests/tables/<name>, cells as text, without the comment and the header line.
inline std::vector<std::vector<std::string>> table(const std::string& name) {
  std::ifstream file(ASSAY_SOURCE_DIR "/tests/tables/" + name);
  if (!file) throw std::runtime_error("no table " + name);
  std::string line;
  std::getline(file, line);
  std::getline(file, line);
  std::vector<std::vector<std::string>> rows;
  while (std::getline(file, line)) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    rows.push_back(cells);
  }
  return rows;
}

}  // namespace assay::tests
