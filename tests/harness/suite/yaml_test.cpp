#include "harness/suite/yaml.h"

#include "estimators/stream.h"
#include "harness/base/text_file.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

Document read(const std::string& text) { return {"x.yaml", text}; }

std::string refused(const std::string& text) {
  return refusal([&] { read(text); });
}

TEST(Yaml, KeepsEveryPlace) {
  const Document document = read("a: 1\nlist:\n  - x\n  - {k: 'v'}\nblock: |\n   text\n");
  const Value& root = document.root();
  EXPECT_EQ(to_string(root.where()), "x.yaml:1:1");
  EXPECT_EQ(to_string(root.find("a")->where()), "x.yaml:1:4");
  EXPECT_EQ(to_string(document.key(*root.find("a"))), "x.yaml:1:1");
  const Value& list = *root.find("list");
  EXPECT_EQ(to_string(list.where()), "x.yaml:3:3");
  EXPECT_EQ(to_string(document.key(list)), "x.yaml:2:1");
  EXPECT_EQ(to_string(list.items()[0].where()), "x.yaml:3:5");
  const Value& quoted = *list.items()[1].find("k");
  EXPECT_EQ(to_string(quoted.where()), "x.yaml:4:10");
  EXPECT_EQ(to_string(document.key(quoted)), "x.yaml:4:6");
  EXPECT_EQ(to_string(root.find("block")->where()), "x.yaml:6:4");
  EXPECT_EQ(document.line(4), "  - {k: 'v'}");
  EXPECT_EQ(document.line(0), "");
  EXPECT_EQ(document.line(7), "");
}

TEST(Yaml, KeepsScalarsAsWritten) {
  const Document document = read("{n: no, e: 1e6, o: 010, q: \"1\", s: a b, d: 2026-11-21}");
  const Value& root = document.root();
  EXPECT_EQ(root.find("n")->text(), "no");
  EXPECT_EQ(root.find("e")->count("e"), 1000000U);
  EXPECT_EQ(root.find("o")->text(), "010");
  EXPECT_EQ(root.find("q")->number("q"), 1);
  EXPECT_EQ(root.find("s")->text(), "a b");
  EXPECT_EQ(root.find("d")->text(), "2026-11-21");
}

TEST(Yaml, AQuotedMergeKeyIsAKey) { EXPECT_NE(read("'<<': 1").root().find("<<"), nullptr); }

TEST(Yaml, ReadsAFileWithAByteOrderMarkAndWindowsLineEnds) {
  const Document document = read("\xEF\xBB\xBFkey: 1\r\nb: 2\r\n");
  EXPECT_EQ(to_string(document.key(*document.root().find("key"))), "x.yaml:1:1");
  EXPECT_EQ(document.root().find("b")->text(), "2");
  EXPECT_EQ(document.line(1), "key: 1");
}

TEST(Yaml, BombsAreRefusedAtOnce) {
  const std::string deep = std::string(400, '[') + std::string(400, ']');
  EXPECT_EQ(refused("a: " + deep), "1:67: nested deeper than 64 levels");
  EXPECT_NE(refused("a: " + std::string(100000, '[')), "(nothing was refused)");
  std::string aliases = "a: &a [x, x, x, x, x, x, x, x, x, x]\n";
  for (char c = 'b'; c < 'k'; ++c) {
    const std::string all = std::string("*") + static_cast<char>(c - 1) + ", ";
    aliases += std::string(1, c) + ": &" + c + " [" + all + all + all + all + "]\n";
  }
  EXPECT_EQ(refused(aliases).substr(0, 27), "1:4: anchors and aliases ar");
  // An alias of nothing is met before it is known for one.
  EXPECT_EQ(refused("a: *b\n").substr(4), refused("a: &b c\n").substr(4));
}

TEST(Yaml, DeepestNestingThatIsAllowedIsRead) {
  const std::string text = std::string(64, '[') + std::string(64, ']');
  EXPECT_EQ(read(text).root().kind(), Value::Kind::list);
}

TEST(Yaml, AFlowValueOfTheCommandLineHasThePlaceOfItsOption) {
  const Value value = read_flow("{light: {radiance: 2}, n: [1, 2]}", {"--set a.b=…", 0, 0});
  EXPECT_EQ(value.find("light")->find("radiance")->number("x"), 2);
  EXPECT_EQ(to_string(value.find("n")->items()[1].where()), "--set a.b=…");
  EXPECT_EQ(refusal([] { read_flow("[1, 2", {}); }).substr(0, 9), "`[1, 2`: ");
  EXPECT_EQ(refusal([] { read_flow(" ", {}); }), "a value is missing after the `=`");
  EXPECT_EQ(refusal([] { read_flow("a: 1\nb: 2", {}); }), "a value is one line");
}

TEST(Split, KeepsBracketsAndQuotesTogether) {
  EXPECT_EQ(split_outside_brackets("a,b=[1,{c: 2,d: 3}],e='x,y',f=\"[\""),
            (std::vector<std::string>{"a", "b=[1,{c: 2,d: 3}]", "e='x,y'", "f=\"[\""}));
  EXPECT_EQ(split_outside_brackets(""), std::vector<std::string>{""});
  EXPECT_EQ(split_outside_brackets("a],b"), (std::vector<std::string>{"a]", "b"}));
}

TEST(Utf8, IsAskedForByteByByte) {
  const auto check = [](const std::string& text) {
    return refusal([&] { require_utf8(text, "f"); });
  };
  constexpr const char* fine = "(nothing was refused)";
  EXPECT_EQ(check("plain\ttext\r\n"), fine);
  EXPECT_EQ(check("é € \xF0\x9F\x98\x80 \xEF\xBF\xBD"), fine);
  EXPECT_EQ(check("a\nb\xC0\x80").substr(0, 5), "2:2: ");      // overlong
  EXPECT_EQ(check("\xED\xA0\x80").substr(0, 5), "1:1: ");      // surrogate
  EXPECT_EQ(check("\xF4\x90\x80\x80").substr(0, 5), "1:1: ");  // above U+10FFFF
  EXPECT_EQ(check("ab\xE2\x82").substr(0, 5), "1:3: ");        // cut short
  EXPECT_EQ(check(std::string("a\0b", 3)).substr(0, 5), "1:2: ");
}

TEST(Caret, StandsBelowTheColumn) {
  EXPECT_EQ(caret_below("alpha: 3", 8), "  alpha: 3\n         ^\n");
  EXPECT_EQ(caret_below("é: x", 5), "  é: x\n     ^\n");
  EXPECT_EQ(caret_below("\tx", 2), "  \tx\n  \t^\n");
  EXPECT_EQ(caret_below("ab", 99), "  ab\n    ^\n");
  EXPECT_EQ(caret_below("", 1), "  \n  ^\n");
}

TEST(Caret, CutsALongLineAroundTheColumn) {
  const std::string line = std::string(500, 'a') + "B" + std::string(500, 'c');
  const std::string text = caret_below(line, 501);
  const std::size_t end = text.find('\n');
  const std::size_t caret = text.find('^') - end - 1;
  EXPECT_LT(end, 120U);
  EXPECT_EQ(text[caret], 'B');
}

// Any bytes are a document or an InputError: what yaml-cpp throws never gets out.
TEST(YamlFuzz, AnyTextIsReadOrRefused) {
  const std::string alphabet = "ab:  -[]{},'\"|>&*!%#?@`~<\n\n\t\\0.é=";
  int read_well = 0;
  for (std::uint64_t i = 0; i < 50000; ++i) {
    Stream random({3}, i);
    std::string text(random() % 30, ' ');
    for (char& c : text) c = alphabet[random() % alphabet.size()];
    try {
      read(text);
      ++read_well;
    } catch (const InputError& e) {
      ASSERT_GE(e.where().line, 1) << text << e.what();
      ASSERT_GE(e.where().column, 1) << text << e.what();
    }
  }
  EXPECT_GT(read_well, 100);
}

}  // namespace
}  // namespace assay::harness
