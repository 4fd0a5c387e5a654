#include "estimators/catalogue.h"
#include "harness/command/commands.h"
#include "harness/command/help.h"
#include "harness/draws/sampler_setup.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

std::string manual_of(const std::string& plugin) {
  return manual(find_plugin(plugin, {}), catalogue());
}

/// The text that a command prints, which ends well.
std::string printed(const std::function<int()>& command) {
  const Said said = said_by(command);
  EXPECT_EQ(said.code, 0);
  return said.text;
}

TEST(Describe, TellsWhatIsKnownExactly) {
  const std::string text = manual_of("analytic/dart_throwing");
  EXPECT_THAT(text, testing::StartsWith("analytic/dart_throwing\n"));
  EXPECT_THAT(text, HasSubstr("area: mean 3.14159265359, variance of a primary 2.69676621"));
  EXPECT_THAT(text, HasSubstr(" values in\n      [0, 4]\n"));
  EXPECT_THAT(text, HasSubstr("bias        unbiased"));
}

TEST(Describe, ListsParametersSamplersAndMutants) {
  const std::string text = manual_of("luminaire/area");
  EXPECT_THAT(text, HasSubstr("scene: structure"));
  EXPECT_THAT(text, HasSubstr("samplers\n"));
  for (const Entry& entry : catalogue()) {
    const bool listed = entry.information.original == "luminaire/area";
    const std::string line = "  " + entry.information.name + ":";
    EXPECT_THAT(text, listed ? testing::Matcher<std::string>(HasSubstr(line))
                             : testing::Matcher<std::string>(Not(HasSubstr(line))));
  }
}

TEST(Describe, NamesTheOriginalAndTheDefectOfAMutantAndCallsNoneUnbiased) {
  for (const Entry& entry : catalogue()) {
    if (entry.information.original.empty()) continue;
    EXPECT_THAT(manual(entry, catalogue()),
                AllOf(HasSubstr("mutant of   " + entry.information.original + "\n"),
                      HasSubstr("defect      "), HasSubstr("bias        that of its defect\n")));
  }
}

TEST(Describe, SaysWhatIsKnownOfRecordedRows) {
  EXPECT_THAT(manual_of("recorded"),
              AllOf(HasSubstr("bias        unknown"),
                    HasSubstr("primaries   not averaged; 1 unless given\n")));
}

// Every sampler and marginal that a manual offers can be named in a claim, and no other is offered.
TEST(Describe, OffersThePartsThatClaimsCanName) {
  EXPECT_THAT(manual_of("luminaire/area"),
              HasSubstr("point: triangle (barycentric); marginals u v\n"));
  EXPECT_THAT(manual_of("luminaire/solid_angle"),
              HasSubstr("square: unit square; marginals u v\n"));
  EXPECT_THAT(manual_of("luminaire/cosine"),
              HasSubstr("direction: hemisphere (solid angle); marginals theta phi\n"));
  for (const Entry& entry : catalogue()) {
    const std::vector<ParameterInformation>& declared = entry.information.parameters;
    const auto required = [](const ParameterInformation& p) { return p.fallback.empty(); };
    if (std::ranges::any_of(declared, required)) continue;
    Parameters parameters(entry.information.name, declared, Value{}, ".");
    const std::string text = manual(entry, catalogue());
    std::shared_ptr<const assay::Setup> setup;
    const std::string refused = refusal([&] { setup = entry.prepare(parameters); });
    if (setup == nullptr) {
      // Some mutants cannot live in the scene that their original has by default; data need a file.
      EXPECT_THAT(refused, AnyOf(HasSubstr("never end"), HasSubstr("focal plane"),
                                 HasSubstr("is needed, or `run`")))
          << entry.information.name;
      continue;
    }
    for (const NamedSampler& named : setup->samplers()) {
      const std::size_t samplers = text.find("\nsamplers\n");
      ASSERT_NE(samplers, text.npos) << entry.information.name;
      const std::string line = text.substr(text.find("\n  " + named.name + ": ", samplers));
      const bool offered = line.substr(0, line.find('\n', 1)).find("marginals") != line.npos;
      EXPECT_EQ(offered, refusal([&] { sampler_setup(named, {}); }) == "(nothing was refused)")
          << entry.information.name << "." << named.name;
    }
  }
}

TEST(Describe, SaysWhyChannelsAreNotKnownYet) {
  Entry entry{
      .information =
          {.name = "a/b",
           .summary = "Needs a number.",
           .parameters = {{.name = "n", .summary = "how many", .unit = "m", .range = above(0)}}},
      .prepare = [](Parameters&) { return std::shared_ptr<const assay::Setup>{}; }};
  const std::string text = manual(entry, {});
  EXPECT_THAT(text, HasSubstr("n: number, (0, inf), m, required"));
  EXPECT_THAT(text, HasSubstr("channels: known once its parameters are given"));
}

TEST(Describe, KeepsEveryManualWithinThePage) {
  for (const Entry& entry : catalogue()) {
    for (const std::string& line : lines(manual(entry, catalogue()))) {
      const auto columns = std::ranges::count_if(
          line, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80; });
      EXPECT_LE(columns, page_width()) << line;
    }
  }
}

TEST(Wrapped, BreaksAtBlanksElseAtTheWidthAndKeepsLineEnds) {
  EXPECT_EQ(wrapped("one two three\nfour", 1, 9), " one two\n three\n four\n");
  EXPECT_EQ(wrapped("unbreakable", 0, 5), "unbre\nakabl\ne\n");
}

TEST(List, PrintsEveryPluginOnALine) {
  std::string expected;
  for (const Entry& entry : catalogue()) expected += entry.information.name + "\n";
  EXPECT_EQ(printed([] { return print_list({.what = "plugins"}); }), expected);
}

TEST(List, PrintsEveryRowOfATableIn80Columns) {
  for (const Table& table : tables()) {
    const std::string text = printed([&] { return print_list({.what = table.plural}); });
    for (const TableRow& row : table.rows) {
      EXPECT_THAT(text, HasSubstr(row.name + " ")) << table.plural;
      EXPECT_FALSE(row.summary.empty()) << row.name;
    }
    for (const std::string& line : lines(text)) EXPECT_LE(line.size(), 80U) << line;
  }
}

TEST(Describe, PrintsTheRowsOfAName) {
  const std::string t = printed([] { return describe("t"); });
  EXPECT_THAT(t, HasSubstr("Student's t"));
  EXPECT_THAT(t, HasSubstr("test: t"));
  // A method and a quantity have this name.
  const std::string quantile = printed([] { return describe("quantile"); });
  EXPECT_THAT(quantile, HasSubstr("quantile, a method"));
  EXPECT_THAT(quantile, HasSubstr("quantile, a quantity"));
  EXPECT_THAT(printed([] { return describe("normal"); }), HasSubstr("normal(mean, sd)"));
  EXPECT_THAT(printed([] { return describe("rounding"); }), HasSubstr("a gate"));
}

}  // namespace
}  // namespace assay::harness
