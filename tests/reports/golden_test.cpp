// Every writer against an approved file. After a wanted change of a format, run the test program
// with ASSAY_APPROVE=1 in the environment, read the difference, and commit the files.

#include "reports/formats/console.h"
#include "reports/formats/json.h"
#include "reports/formats/junit.h"
#include "reports/formats/markdown.h"
#include "reports/formats/metrics.h"
#include "reports/record/file.h"
#include "tests/prelude.h"
#include "tests/reports/example_record.h"

namespace assay::reports {
namespace {

std::filesystem::path approved(const char* name) {
  return std::filesystem::path(ASSAY_SOURCE_DIR) / "tests" / "golden" / name;
}

std::string contents(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// The place where two texts part, with some of the text that follows.
std::string first_difference(const std::string& a, const std::string& b) {
  const auto at = static_cast<std::size_t>(
      std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin());
  std::ostringstream text;
  text << "byte " << at << "\nwritten:  " << a.substr(at, 120)
       << "\napproved: " << b.substr(std::min(at, b.size()), 120);
  return text.str();
}

void compare(const char* name, const std::string& written) {
  if (std::getenv("ASSAY_APPROVE") != nullptr) write_whole(approved(name), written);
  const std::string wanted = contents(approved(name));
  EXPECT_TRUE(written == wanted) << name << " differs at " << first_difference(written, wanted);
}

TEST(Approved, JsonIsAsApproved) { compare("record.json", json(example_record())); }

TEST(Approved, JunitIsAsApproved) { compare("junit.xml", junit(example_record())); }

TEST(Approved, MarkdownIsAsApproved) { compare("report.md", markdown(example_record())); }

TEST(Approved, ConsoleIsAsApproved) {
  compare("console.txt", console(example_record()));
  compare("console-60.txt", console(example_record(), {.width = 60, .slowest = 2}));
  compare("console-v.txt", console(example_record(), {.detail = 1}));
  compare("console-vv.txt", console(example_record(), {.width = 100, .detail = 2}));
}

TEST(Approved, MetricsAreAsApproved) { compare("metrics.txt", metrics(example_record())); }

}  // namespace
}  // namespace assay::reports
