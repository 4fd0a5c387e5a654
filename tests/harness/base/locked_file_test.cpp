#include "harness/base/whole_file.h"

#include "harness/base/text_file.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

TEST(LockedFile, NamesAPathThatCannotBeOpened) {
  const Workplace place;
  EXPECT_THAT(thrown<std::runtime_error>([&] { LockedFile(place.file("missing/n.ledger")); }),
              HasSubstr("missing/n.ledger"));
}

// Read, add one, write: without turns some of the 400 would be lost almost surely.
TEST(LockedFile, ConcurrentThreadsTakeTurns) {
  const Workplace place;
  const std::string path = place.file("n.ledger");
  const auto add_hundred = [&] {
    for (int i = 0; i < 100; ++i) {
      const LockedFile lock(path);
      lock.replace(read_text_file(path) + "x");
    }
  };
  { const std::jthread a(add_hundred), b(add_hundred), c(add_hundred), d(add_hundred); }
  EXPECT_EQ(read_text_file(path).size(), 400U);
}

}  // namespace
}  // namespace assay::harness
