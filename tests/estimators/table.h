#pragma once

// Tables of tests/tables.

#include "tests/prelude.h"

namespace assay::tests {

inline std::ifstream opened_table(const std::string& name) {
  std::ifstream file(ASSAY_SOURCE_DIR "/tests/tables/" + name);
  if (!file) throw std::runtime_error("no table " + name);
  return file;
}

inline std::vector<std::string> split(const std::string& text, const std::string& separator) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t at; (at = text.find(separator, from)) != text.npos; from = at + separator.size())
    parts.push_back(text.substr(from, at - from));
  parts.push_back(text.substr(from));
  return parts;
}

/// The rows of tests/tables/<name>, cells as text, without the comment and the header line.
inline std::vector<std::vector<std::string>> table(const std::string& name) {
  std::ifstream file = opened_table(name);
  std::string line;
  std::getline(file, line);
  std::getline(file, line);
  std::vector<std::vector<std::string>> rows;
  while (std::getline(file, line)) rows.push_back(split(line, ","));
  return rows;
}

/// A line of a table of parameters, and the line at the margin that it stands below.
struct ParameterRow {
  std::string heading;
  std::string text;
};

/// Names are replaced by their texts: those of `$name = text` in the file, and `names`.
inline std::vector<ParameterRow> parameter_rows(
    const std::string& table, std::vector<std::pair<std::string, std::string>> names = {}) {
  std::ifstream file = opened_table(table);
  std::vector<ParameterRow> rows;
  std::string heading;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    for (auto name = names.rbegin(); name != names.rend(); ++name) {
      for (std::size_t at; (at = line.find(name->first, 1)) != line.npos;)
        line.replace(at, name->first.size(), name->second);
    }
    if (line.starts_with('$')) {
      const auto parts = split(line, " = ");
      names.emplace_back(parts.at(0), parts.at(1));
    } else if (line.starts_with(' ')) {
      rows.push_back({heading, line.substr(2)});
    } else {
      heading = line;
    }
  }
  return rows;
}

/// The rows `text => what is said of it` of refused_texts.txt below a heading that begins so.
inline std::vector<std::pair<std::string, std::string>> refused_texts(const std::string& heading) {
  std::vector<std::pair<std::string, std::string>> rows;
  for (const ParameterRow& row : parameter_rows("refused_texts.txt")) {
    if (!row.heading.starts_with(heading)) continue;
    auto parts = split(row.text, " => ");
    for (const auto& [escape, character] : {std::pair{"\\n", '\n'}, {"\\r", '\r'}, {"\\t", '\t'}}) {
      for (std::size_t at; (at = parts.at(0).find(escape)) != std::string::npos;)
        parts[0].replace(at, 2, 1, character);
    }
    rows.emplace_back(parts.at(0), parts.at(1));
  }
  if (rows.empty()) throw std::runtime_error("no texts for " + heading);
  return rows;
}

}  // namespace assay::tests
