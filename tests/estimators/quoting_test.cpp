#include "estimators/core/quoting.h"

#include "tests/prelude.h"

namespace assay {
namespace {

TEST(Quoting, ReadsBackInAShell) {
  EXPECT_EQ(shell_quoted("a/b-c_1.yaml"), "a/b-c_1.yaml");
  EXPECT_EQ(shell_quoted(""), "''");
  EXPECT_EQ(shell_quoted("mean(a) == 1"), "'mean(a) == 1'");
  EXPECT_EQ(shell_quoted("it's"), "'it'\\''s'");
}

TEST(Quoting, ReadsBackInPython) {
  EXPECT_EQ(python_quoted("it's a"), "\"it's a\"");
  EXPECT_EQ(python_quoted("\"\\"), "\"\\\"\\\\\"");
}

TEST(Quoting, ShowsTheBeginningOnOneLine) {
  EXPECT_EQ(shown("one\ntwo\n"), "one two");
  EXPECT_EQ(shown("a\x1b[1m\t\x7f"), "a?[1m??");
  EXPECT_EQ(shown(std::string(60, 'x')), std::string(60, 'x'));
  EXPECT_EQ(shown(std::string(61, 'x')), std::string(60, 'x') + "…");
  EXPECT_EQ(shown("abc def", 4), "abc…");
}

TEST(Quoting, CutsNoCharacter) {
  EXPECT_EQ(shown("Größe", 4), "Grö…");
  EXPECT_EQ(shown("Größe", 3), "Gr…");
  EXPECT_EQ(shown("a€", 3), "a…");
  EXPECT_EQ(shown("a€", 4), "a€");
  // Bytes that are no UTF-8 are cut all the same.
  EXPECT_EQ(shown(std::string(9, '\x80'), 6), std::string(3, '\x80') + "…");
  EXPECT_EQ(shown("€", 0), "…");
}

}  // namespace
}  // namespace assay
