// Levels and powers of whole claims on images: suite, pilot, plan, looks and verdict, seed by seed,
// of tests/tables/image_levels.txt. The seeds are 1, 2, 3, ….

#include <fmt/format.h>

#include "tests/harness/many_seeds.h"
#include "tests/harness/table.h"

namespace assay::harness {
namespace {

constexpr double level_of_each = 0.05;  // of each test

class ImageLevel : public TestWithParam<ClaimSection> {};

TEST_P(ImageLevel, IsAsTheTableSays) {
  const auto& [section, estimators, rows] = GetParam();
  std::string tests;
  for (const ClaimRow& row : rows) {
    tests += fmt::format("  - {{name: '{}', claim: {}}}\n", &row - rows.data(), row.text);
  }
  const std::string text = fmt::format("suite: s\nalpha: {}\nbeta: {}\nestimators:\n{}tests:\n{}",
                                       level_of_each * static_cast<double>(rows.size()),
                                       level_of_each, estimators, tests);
  const std::size_t seeds = tests::repetitions(std::stoul(section.substr(section.rfind(' '))));
  const auto outcomes = over_seeds(seeds, [&](std::uint64_t) { return text; });
  for (const ClaimRow& row : rows) {
    const Outcomes& mine = outcomes.at(std::to_string(&row - rows.data()));
    for (const std::string& words : row.words) {
      std::istringstream stream(words);
      std::string verdict, at, bound;
      double limit = 0;
      stream >> verdict >> at >> bound >> limit;
      const auto is_it = [&](reports::Verdict each) { return to_string(each) == verdict; };
      double share = static_cast<double>(std::ranges::count_if(mine.verdicts, is_it)) /
                     static_cast<double>(seeds);
      if (bound == "least") std::tie(share, limit) = std::pair(1 - share, 1 - limit);
      const bool kept =
          limit > 0 ? !tests::too_many(share, limit, static_cast<double>(seeds)) : share == 0;
      EXPECT_TRUE(kept) << row.text << ": " << words << ", not so in " << share;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Table, ImageLevel, ValuesIn(sections_of("image_levels.txt")),
                         name_of_section);

}  // namespace
}  // namespace assay::harness
