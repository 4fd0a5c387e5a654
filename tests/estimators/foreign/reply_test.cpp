#include "estimators/foreign/protocol.h"
#include "tests/estimators/table.h"

namespace assay::foreign {
namespace {

constexpr Question question{.key = 0x123456789abcdef0, .first = 5, .count = 2, .primaries = 64};
const std::string text_question = "305419896 2596069104 5 2 64\n";

std::string bytes_of(const std::vector<double>& numbers) {
  std::string bytes(8 * numbers.size(), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

/// Gives the bytes in pieces; whether the reply is complete after the last.
bool feed(Reply& reply, std::string_view bytes, std::size_t piece) {
  while (!bytes.empty()) {
    const std::span<char> space = reply.space();
    const std::size_t count = std::min({piece, bytes.size(), space.size()});
    std::memcpy(space.data(), bytes.data(), count);
    bytes.remove_prefix(count);
    if (reply.take(count)) return true;
  }
  return false;
}

std::vector<double> numbers_of(const std::string& bytes, Numbers kind, std::size_t piece) {
  Reply reply(question, 2, kind);
  EXPECT_TRUE(feed(reply, bytes, piece));
  return reply.numbers();
}

std::string refusal(const std::string& bytes, Numbers kind) {
  Reply reply(question, 2, kind);
  try {
    return feed(reply, bytes, bytes.size()) ? "complete" : "incomplete: " + reply.ends_early();
  } catch (const ProtocolError& error) {
    return error.what();
  }
}

TEST(Reply, QuestionsAreWordsOrBytes) {
  EXPECT_EQ(to_bytes(question, Numbers::text), text_question);
  const std::string bytes = to_bytes(question, Numbers::binary);
  ASSERT_EQ(bytes.size(), 32u);
  EXPECT_EQ(bytes.substr(0, 8), "\xf0\xde\xbc\x9a\x78\x56\x34\x12");
  EXPECT_EQ(bytes.substr(8, 2), std::string("\x05\0", 2));
}

TEST(Reply, IsTheSameInPiecesOfAnySize) {
  const std::string text = "1 2.5\n-3e-2\t+4\n" + text_question;
  const std::string binary = bytes_of({1, 2.5, -0.03, 4}) + to_bytes(question, Numbers::binary);
  for (const std::size_t piece : {1U, 2U, 3U, 7U, 31U, 64U, 1000U}) {
    EXPECT_THAT(numbers_of(text, Numbers::text, piece), ElementsAre(1, 2.5, -0.03, 4));
    EXPECT_THAT(numbers_of(binary, Numbers::binary, piece), ElementsAre(1, 2.5, -0.03, 4));
  }
}

// Values that are not finite are kept; lines may end as Windows ends them.
TEST(Reply, IsReadLineByLine) {
  const auto numbers =
      numbers_of("nan inf\r\n-inf 1\r\n305419896 2596069104 5 2 64\r\n", Numbers::text, 1000);
  EXPECT_TRUE(std::isnan(numbers[0]));
  EXPECT_TRUE(std::isinf(numbers[1]));
  EXPECT_LT(numbers[2], 0);
}

TEST(Reply, RefusesWhatIsNoReply) {
  for (const auto& [text, said] : refused_texts("replies")) {
    EXPECT_THAT(refusal(text, Numbers::text), HasSubstr(said)) << text;
  }
  const auto binary = [](const std::string& bytes) {
    return refusal(bytes + to_bytes(question, Numbers::binary), Numbers::binary);
  };
  EXPECT_THAT(binary(bytes_of({1, 2, 3})),
              HasSubstr("incomplete: its reply has 3 of 4 numbers and lacks observation 6"));
  EXPECT_THAT(binary(bytes_of({1, 2, 3, 4, 5, 6})), HasSubstr("does not end with the question"));
  EXPECT_THAT(binary("hello" + bytes_of({1, 2, 3, 4})),
              AllOf(HasSubstr("does not end with the question"), HasSubstr("begins with `hello")));
}

TEST(Reply, RefusesALineWithoutEnd) {
  EXPECT_THAT(refusal(std::string(1000, '1'), Numbers::text), HasSubstr("a line without end"));
}

}  // namespace
}  // namespace assay::foreign
