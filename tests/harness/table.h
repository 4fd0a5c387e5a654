#pragma once

// Tables of tests/tables whose rows are claims, in sections.

#include "tests/prelude.h"

namespace assay::harness {

struct ClaimRow {
  std::string text;
  std::vector<std::string> words;            ///< lines below it that begin with four blanks
  std::map<std::string, std::string> files;  ///< by name, how their numbers are made
};

struct ClaimSection {
  std::string name;
  std::string head;
  std::vector<ClaimRow> rows;
};

/// `=== NAME` begins a section, whose head ends at `---`. `FILE.txt = NUMBERS` holds for the rows
/// below it, up to the next section.
inline std::vector<ClaimSection> sections_of(const std::string& table) {
  std::ifstream file(ASSAY_SOURCE_DIR "/tests/tables/" + table);
  std::vector<ClaimSection> sections;
  std::map<std::string, std::string> files;
  bool in_head = false;
  for (std::string line; std::getline(file, line);) {
    const std::size_t equals = line.find(".txt = ");
    if (line.starts_with("=== ")) {
      sections.push_back({.name = line.substr(4), .head = "", .rows = {}});
      files.clear();
      in_head = true;
    } else if (in_head) {
      in_head = line != "---";
      if (in_head) sections.back().head += line + "\n";
    } else if (line.starts_with("    ")) {
      sections.back().rows.back().words.push_back(line.substr(4));
    } else if (!line.empty() && !line.starts_with('#') && equals != line.npos) {
      files[line.substr(0, equals + 4)] = line.substr(equals + 7);
    } else if (!line.empty() && !line.starts_with('#')) {
      sections.back().rows.push_back({.text = line, .words = {}, .files = files});
    }
  }
  return sections;
}

/// The head with this claim. Estimators that it does not name are comments: preparing takes time.
inline std::string suite_with(const ClaimSection& section, const std::string& claim) {
  std::string suite;
  bool of_estimators = false;
  for (const std::string& line : tests::lines(section.head)) {
    if (line == "tests:") of_estimators = false;
    const auto unnamed = [&] {
      const std::string name = line.substr(2, line.find(':') - 2);
      return !std::regex_search(claim, std::regex("[( ]" + name + "[),. }]"));
    };
    suite += of_estimators && unnamed() ? "#" : "";
    suite += (line == "  -" ? "  - " + claim : line) + "\n";
    if (line == "estimators:") of_estimators = true;
  }
  return suite;
}

/// Such a suite of a section of verdicts.txt.
inline std::string suite_with(const std::string& section, const std::string& claim) {
  for (const ClaimSection& each : sections_of("verdicts.txt")) {
    if (each.name == section) return suite_with(each, claim);
  }
  throw std::out_of_range("no section " + section);
}

/// The name of a test of a section.
inline std::string name_of_section(const testing::TestParamInfo<ClaimSection>& section) {
  std::string name = section.param.name;
  std::ranges::replace_if(
      name, [](char c) { return !std::isalnum(c); }, '_');
  return name;
}

inline void PrintTo(const ClaimSection& section, std::ostream* out) { *out << section.name; }

}  // namespace assay::harness
