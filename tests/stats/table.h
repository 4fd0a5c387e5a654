#pragma once

#include "tests/prelude.h"

namespace assay::tests {

// One row of tests/tables/NAME.csv, by column name. Texts stay texts.
class Row {
 public:
  explicit Row(std::map<std::string, std::string> cells) : cells_(std::move(cells)) {}

  const std::string& text(const std::string& column) const { return cells_.at(column); }
  // strtod and not stod: values below the range of a double (an upper tail of 1e-400) read as zero.
  double operator[](const std::string& column) const {
    return std::strtod(cells_.at(column).c_str(), nullptr);
  }

 private:
  std::map<std::string, std::string> cells_;
};

inline std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

inline std::vector<Row> read_table(const std::string& name) {
  std::ifstream file(std::string(ASSAY_SOURCE_DIR) + "/tests/tables/" + name + ".csv");
  std::string line;
  std::getline(file, line);
  if (!line.starts_with("# ")) throw std::runtime_error(name + ": first line must be the command");
  std::getline(file, line);
  const std::vector<std::string> header = split(line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = split(line);
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; i < header.size(); ++i) row[header[i]] = cells.at(i);
    rows.emplace_back(std::move(row));
  }
  if (rows.empty()) throw std::runtime_error(name + ": no rows");
  return rows;
}

// Error of a logarithm of a probability. Relative error of p above 1e-300, of ln p below. Near p =
// 1, relative error of 1 - p.
inline double log_p_error(double computed, double expected) {
  const double difference = std::abs(computed - expected);
  if (expected == 0) return difference;
  const double size = std::abs(expected);
  if (size > 690 || size < 1) return difference / size;
  return difference;
}

inline void expect_near_or_infinite(double value, double expected, double tolerance) {
  EXPECT_TRUE(value == expected || std::abs(value - expected) <= tolerance)
      << value << ", expected " << expected;
}

}  // namespace assay::tests
