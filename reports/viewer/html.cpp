#include "reports/viewer/html.h"

#include <zlib.h>

#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "reports/formats/base64.h"
#include "reports/formats/markdown.h"
#include "reports/record/calibration.h"
#include "reports/viewer/page.h"
#include "reports/viewer/pictures.h"
#include "reports/words/ledger.h"
#include "reports/words/summary.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

/// The bytes as gzip without a date: the same bytes give the same file.
std::vector<std::uint8_t> compressed(std::string_view bytes) {
  constexpr int with_gzip_header = 16 + MAX_WBITS;
  z_stream stream{};
  if (deflateInit2(&stream, 9, Z_DEFLATED, with_gzip_header, 9, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::runtime_error("zlib has no memory to compress the page");
  std::vector<std::uint8_t> out(deflateBound(&stream, static_cast<uLong>(bytes.size())));
  std::vector<Bytef> in(bytes.begin(), bytes.end());
  stream.next_in = in.data();
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  const int code = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (code != Z_STREAM_END) throw std::runtime_error("zlib did not compress the page");
  return out;
}

/// The viewer's page of these bytes. `title` and `tables` are plain text.
std::string page_of(const std::string& title, const std::string& tables, std::string_view bytes) {
  std::string page;
  std::string_view rest = viewer_page;
  // The places of the page's own text, in their order.
  const auto put = [&](std::string_view place, const std::string& text) {
    const std::size_t at = rest.find(place);
    page += rest.substr(0, at);
    page += text;
    rest.remove_prefix(at + place.size());
  };
  put("{{title}}", escape_xml(one_line(title)));
  put("{{markdown}}", escape_xml(tables));
  put("{{record}}", base64(compressed(bytes)));
  return page + std::string(rest);
}

}  // namespace

std::string html(const Record& record) {
  const std::string alarm = alarm_count(record);
  const std::string title = tally_sentence(tally(record)) + (alarm.empty() ? "" : "; " + alarm);
  return page_of("Assay: " + title, markdown(record), packed(record));
}

std::string html(const Calibration& calibration) {
  return page_of("Assay: calibration, " + verdict_sentence(calibration), console(calibration),
                 packed(calibration));
}

}  // namespace assay::reports
