// Hellos and replies of other programs (estimators/foreign/). All bytes are understood or refused,
// in pieces as in one. A reply that was understood is written and read again as the same.

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

#include "estimators/foreign/protocol.h"
#include "tests/fuzz/case.h"

namespace {

using namespace assay::foreign;
using assay::fuzz::require;

void hello(std::string_view text) {
  is_whole_hello(text);
  try {
    // More than 1024 numbers would only try the memory.
    const Hello said = parse_hello(text, 1024);
    const std::string again = to_text(said);
    require(to_text(parse_hello(again)) == again);
  } catch (const ProtocolError& error) {
    require(*error.what() != '\0' || text.find("error") != std::string_view::npos);
  }
}

using Numbers = std::optional<std::vector<double>>;

/// The numbers of a reply that comes in pieces of this size; nothing where it is refused or is not
/// complete.
Numbers heard(std::string_view bytes, const Question& question, assay::foreign::Numbers kind,
              std::size_t piece) {
  Reply reply(question, 2, kind);
  try {
    while (!bytes.empty()) {
      const std::span<char> space = reply.space();
      require(!space.empty());
      const std::size_t count = std::min({piece, bytes.size(), space.size()});
      std::memcpy(space.data(), bytes.data(), count);
      bytes.remove_prefix(count);
      if (reply.take(count)) return bytes.empty() ? Numbers(reply.numbers()) : Numbers();
      reply.ends_early();
    }
  } catch (const ProtocolError&) {
  }
  return {};
}

bool same(const Numbers& a, const Numbers& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->size() == b->size() && std::memcmp(a->data(), b->data(), 8 * a->size()) == 0;
}

void reply(std::string_view bytes, assay::foreign::Numbers kind) {
  const Question question{.key = 1, .first = 2, .count = 3, .primaries = 4};
  const std::string end = to_bytes(question, kind);
  // The end is hard to guess: half of the cases get it for nothing.
  const bool ended = !bytes.empty() && bytes.front() % 2 == 1;
  if (!bytes.empty()) bytes.remove_prefix(1);
  const std::string all = std::string(bytes) + (ended ? end : "");
  const Numbers whole = heard(all, question, kind, all.size());
  if (whole) require(whole->size() == 6);
  for (const std::size_t piece : {1, 3, 8, 29}) {
    require(same(heard(all, question, kind, piece), whole));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes = assay::fuzz::text_of(data + 1, size - 1);
  switch (data[0] % 3) {
    case 0:
      hello(bytes);
      break;
    case 1:
      reply(bytes, assay::foreign::Numbers::text);
      break;
    default:
      reply(bytes, assay::foreign::Numbers::binary);
  }
  return 0;
}
