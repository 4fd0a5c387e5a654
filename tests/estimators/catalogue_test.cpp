#include "estimators/catalogue.h"

#include "tests/prelude.h"

namespace assay {
namespace {

Entry entry(std::string name) {
  return {{.name = std::move(name), .summary = "", .description = ""},
          [](Parameters&) { return std::shared_ptr<const Setup>(); }};
}

std::string refusal_of(std::vector<Entry> entries) {
  return thrown<std::logic_error>([&] { checked(std::move(entries)); });
}

const std::string nothing = thrown([] {});

TEST(Catalogue, IsSortedAndSound) {
  EXPECT_TRUE(
      std::ranges::is_sorted(catalogue(), {}, [](const Entry& e) { return e.information.name; }));
  for (const Entry& e : catalogue()) {
    EXPECT_FALSE(e.information.summary.empty()) << e.information.name;
    EXPECT_FALSE(e.information.description.empty()) << e.information.name;
  }
}

TEST(Catalogue, AnUnknownPluginIsRefusedWithTheNearestName) {
  for (const char* name : {"analytic/dart_throwin", "dart_throwing", "analitic/dart_throwing"}) {
    EXPECT_THAT(thrown<InputError>([&] {
                  find_plugin(name, {"suite.yaml", 4, 9});
                }),
                AllOf(StartsWith("suite.yaml:4:9: there is no plugin"),
                      HasSubstr("`analytic/dart_throwing`?")));
  }
}

TEST(Catalogue, RefusesNamesThatAreMalformedOrUsedTwice) {
  for (const char* name : {"", "a/", "/a", "a//b", "A/b", "a/b c", "a/1b", "a/_b", "a/b-c"}) {
    EXPECT_THAT(refusal_of({entry(name)}), HasSubstr("family/name")) << name;
  }
  EXPECT_THAT(refusal_of({entry("a/b"), entry("a/c"), entry("a/b")}),
              HasSubstr("registered twice"));
  EXPECT_EQ(refusal_of({entry("a"), entry("a/b_2/c")}), nothing);
}

TEST(Catalogue, RefusesIncompleteEntries) {
  Entry mutant = entry("mutants/b");
  EXPECT_NE(refusal_of({mutant}), nothing) << "a mutant without its original";
  mutant.information.original = "a/b";
  mutant.information.defect = "none";
  EXPECT_THAT(refusal_of({mutant}), HasSubstr("which is not there"));
  EXPECT_EQ(refusal_of({mutant, entry("a/b")}), nothing);
  Entry twice = entry("a/b");
  twice.information.parameters = {{.name = "x", .summary = ""}, {.name = "x", .summary = ""}};
  EXPECT_THAT(refusal_of({twice}), HasSubstr("twice"));
  Entry empty = entry("a/b");
  empty.prepare = nullptr;
  EXPECT_THAT(refusal_of({empty}), HasSubstr("prepare"));
}

}  // namespace
}  // namespace assay
