#include <fmt/format.h>

#include "reports/viewer/html_parts.h"
#include "reports/words/describe.h"
#include "reports/words/text.h"
#include "reports/words/summary.h"

namespace assay::reports {

std::string suite_section(const Record& record, std::size_t index) {
  const Suite& suite = record.suites[index];
  std::string out =
      fmt::format("<h2 id=\"s{}\">{}</h2>\n", index, escape_xml(one_line(suite.name)));
  if (!suite.about.empty()) out += fmt::format("<p>{}</p>\n", escape_xml(suite.about));
  const std::string file =
      suite.file.empty() ? "" : fmt::format("<span>{}</span>", escape_xml(one_line(suite.file)));
  out += fmt::format("<div class=\"facts\">{}<span>{}</span><span>{}</span></div>\n", file,
                     escape_xml(levels_text(suite)), tally_sentence(tally(suite)));
  out += kill_section(record, index);
  out += estimator_pictures(suite);
  if (!suite.tests.empty()) out += "<h3>Tests</h3>\n";
  for (const std::size_t t : by_urgency(suite)) out += test_section(suite.tests[t], {index, t});
  return out;
}

}  // namespace assay::reports
