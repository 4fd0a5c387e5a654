// Records of runs (reports/report_formats.h), and the reports made from them. All bytes are a
// record, or are refused with the file's name. A record is written and read again as the same, and
// every report can be made from it.

// options: -max_len=32768

#include "reports/report_formats.h"
#include "tests/fuzz/case.h"

namespace {

using namespace assay::reports;
using assay::fuzz::require;

void report(const Record& record) {
  require(!console(record).empty());
  require(!html(record).empty());
  require(!junit(record).empty());
  require(!markdown(record).empty());
  require(!metrics(record).empty());
  annotations(record);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = assay::fuzz::text_of(data, size);
  try {
    const Record record = read_json(text, "run.json");
    const std::string written = json(record);
    require(json(read_json(written, "run.json")) == written);
    report(record);
  } catch (const ReadError& error) {
    require(std::string_view(error.what()).starts_with("run.json"));
  }
  return 0;
}
