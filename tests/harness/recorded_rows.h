#pragma once

// Rows of a file, made here, and what one test says of them.

#include <fmt/format.h>

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
  return run_in(place, text).tests[0];
}

/// A suite on two files of rows; `tests` are the suite's, one a line.
inline reports::Suite compared(const Workplace& place, const std::vector<double>& a,
                               const std::vector<double>& b, const std::string& tests) {
  place.write("a.txt", file_of(a));
  place.write("b.txt", file_of(b));
  return run_in(place,
                "suite: s\nestimators:\n  a: {plugin: recorded, file: a.txt}\n"
                "  b: {plugin: recorded, file: b.txt}\n"
                "  drawn: {plugin: analytic/normal, primaries: 1}\ntests:\n" +
                    tests);
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

/// Numbers by a description: a list, or `KIND(PARAMETER, COUNT, STREAM)` and then, in any number,
/// `* X`, `+ X`, `N times`, `in N turns`, and `& DESCRIPTION`, which appends.
inline std::vector<double> values_of(const std::string& description) {
  static const std::map<std::string, std::function<double(double, Philox&)>> kinds{
      {"normal", [](double deviation, Philox& r) { return deviation * r.normal(); }},
      {"exponential", [](double mean, Philox& r) { return mean * r.exponential(); }},
      {"lognormal", [](double scale, Philox& r) { return std::exp(scale * r.normal()); }},
      {"rounded", [](double to, Philox& r) { return std::round(to * r.uniform()) / to; }},
  };
  static const std::regex form(R"(\s*(\w+)\(([^,]+), (\d+), (\d+)\)(.*))");
  std::vector<double> values;
  std::smatch head;
  if (!std::regex_match(description, head, form)) {
    std::istringstream list(description);
    for (double value = 0; list >> value;) values.push_back(value);
    return values;
  }
  const double parameter = std::stod(head[2]);
  const auto stream = static_cast<std::uint32_t>(std::stoul(head[4]));
  const auto draw = [&](Philox& random) { return kinds.at(head[1])(parameter, random); };
  values = head[1] == "chain" ? chain(parameter, std::stoul(head[3]), stream)
                              : rows_of(std::stoul(head[3]), stream, draw);
  std::istringstream words(head[5]);
  for (std::string word, next; words >> word;) {
    const std::vector<double> before = values;
    if (word == "&") {
      std::getline(words, next);
      for (const double value : values_of(next)) values.push_back(value);
    } else if (word == "+" || word == "*") {
      const bool adds = word == "+";
      words >> word;
      for (double& value : values) value = adds ? value + std::stod(word) : value * std::stod(word);
    } else if (word == "in") {
      words >> word >> next;
      const std::size_t turns = std::stoul(word);
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = before[i % turns * (values.size() / turns) + i / turns];
      }
    } else {
      words >> next;  // `times`
      for (std::size_t i = 1; i < std::stoul(word); ++i) {
        values.insert(values.end(), before.begin(), before.end());
      }
    }
  }
  return values;
}

/// Rows by a description of theirs; ` | X` behind it is a second column that never varies.
inline std::string file_of(const std::string& description) {
  const std::size_t bar = description.find(" | ");
  if (bar == description.npos) return file_of(values_of(description));
  std::string text = "# columns: moving still\n";
  for (const double value : values_of(description.substr(0, bar))) {
    text += fmt::format("{} {}\n", value, description.substr(bar + 3));
  }
  return text;
}

}  // namespace assay::harness
