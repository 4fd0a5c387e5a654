#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include "harness/base/text_file.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

namespace fs = std::filesystem;

class WriteWhole : public InFolder {
 protected:
  long entries() const { return std::distance(fs::directory_iterator(folder_), {}); }
  std::string refusal(const fs::path& path) const {
    return thrown<std::runtime_error>([&] { write_whole(path, "text"); });
  }
};

TEST_F(WriteWhole, WritesAndReplaces) {
  const fs::path path = folder_ / "report.json";
  write_whole(path, "first");
  const std::string second(3 << 20, 'x');
  write_whole(path, second);
  EXPECT_EQ(bytes_in(path), second);
  EXPECT_EQ(entries(), 1);
}

TEST_F(WriteWhole, RemovesWhatKilledProcessesLeft) {
  std::ofstream(folder_ / ".assay-1.tmp") << "half";
  const fs::path used = folder_ / ".assay-2.tmp";
  const int living = ::open(used.c_str(), O_CREAT | O_WRONLY, 0600);
  ASSERT_EQ(::flock(living, LOCK_EX), 0);
  write_whole(folder_ / "report.json", "text");
  EXPECT_FALSE(fs::exists(folder_ / ".assay-1.tmp"));
  EXPECT_TRUE(fs::exists(used));
  ::close(living);
}

TEST_F(WriteWhole, FollowsALinkInsteadOfReplacingIt) {
  write_whole(folder_ / "real", "old");
  fs::create_symlink(folder_ / "real", folder_ / "link");
  write_whole(folder_ / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(bytes_in(folder_ / "real"), "new");
}

TEST_F(WriteWhole, WritesToAPipeWithoutReplacingIt) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = bytes_in(pipe); });
  write_whole(pipe, "through the pipe");
  reader.join();
  EXPECT_EQ(read, "through the pipe");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(WriteWhole, NamesPathAndReasonOfAFailure) {
  const fs::path missing = folder_ / "nowhere" / "report.json";
  EXPECT_EQ(refusal(missing), "cannot write " + missing.string() + ": No such file or directory");
  EXPECT_EQ(refusal(folder_), "cannot write " + folder_.string() + ": Is a directory");
  const fs::path below_a_file = folder_ / "file" / "report.json";
  write_whole(folder_ / "file", "");
  EXPECT_EQ(refusal(below_a_file), "cannot write " + below_a_file.string() + ": Not a directory");
  EXPECT_EQ(refusal("/dev/full"), "cannot write /dev/full: No space left on device");
}

// A folder where nobody, the superuser included, may create a file.
TEST_F(WriteWhole, LeavesNothingBehindWhereItCannotWrite) {
  EXPECT_EQ(refusal("/proc/self/report.json").rfind("cannot write /proc/self/report.json: ", 0),
            0u);
}

TEST_F(WriteWhole, LeavesNothingBehindWhenTheNameIsRefused) {
  const fs::path path = folder_ / std::string(300, 'n');
  EXPECT_EQ(refusal(path), "cannot write " + path.string() + ": File name too long");
  EXPECT_EQ(entries(), 0);
}

TEST_F(WriteWhole, LeavesTheOldFileWhenTheFolderIsReadOnly) {
  const fs::path path = folder_ / "report.json";
  write_whole(path, "old");
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
  const std::string result = refusal(path);
  fs::permissions(folder_, fs::perms::owner_all);
  // The superuser is not held back by permissions.
  if (::geteuid() == 0) {
    EXPECT_EQ(result, thrown([] {}));
  } else {
    EXPECT_EQ(result, "cannot write " + path.string() + ": Permission denied");
    EXPECT_EQ(bytes_in(path), "old");
  }
  EXPECT_EQ(entries(), 1);
}

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
      write_whole(path, read_text_file(path) + "x");
    }
  };
  { const std::jthread a(add_hundred), b(add_hundred), c(add_hundred), d(add_hundred); }
  EXPECT_EQ(read_text_file(path).size(), 400U);
}

}  // namespace
}  // namespace assay::harness
