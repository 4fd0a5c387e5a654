#include <fmt/format.h>

#include "reports/record/calibration.h"
#include "reports/viewer/html_parts.h"
#include "reports/viewer/html_table.h"
#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

std::string rate_markup(const Rate& rate) {
  if (rate.runs == 0) return "";
  return fmt::format("{:.3g}<br/><span class=\"muted\">{:.2g} to {:.2g}</span>", rate.value(),
                     rate.low, rate.high);
}

std::string share_markup(std::uint64_t count, const Rate& of) {
  if (of.runs == 0) return "";
  return fmt::format("{:.2g}", static_cast<double>(count) / static_cast<double>(of.runs));
}

std::string chosen_markup(const CalibrationCell& cell) {
  std::string out;
  for (const auto& [method, count] : cell.chosen) {
    out += fmt::format("{}{} {:.0f} %", out.empty() ? "" : "<br/>", escape_xml(method),
                       100 * static_cast<double>(count) / static_cast<double>(cell.mistaken.runs));
  }
  return out;
}

std::string verdict_markup(const Calibration& calibration, const CalibrationCell& cell) {
  std::string out;
  if (above(calibration, cell)) out = "procedure errs too often";
  if (unflagged(calibration, cell)) out += std::string(out.empty() ? "" : "; ") + "no red gate";
  return out.empty() ? "<span class=\"green\">ok</span>"
                     : fmt::format("<span class=\"red\">{}</span>", out);
}

std::string table(const Calibration& calibration, double alpha) {
  HtmlTable table({{"law"},
                   {"mistaken", true},
                   {"invalid", true},
                   {"inconclusive", true},
                   {"right at detect", true},
                   {"wrong at detect", true},
                   {"n", true},
                   {"judged by"},
                   {"alone", true},
                   {"red gate", true},
                   {"alone, no red gate", true},
                   {"verdict"}},
                  "cards");
  std::string question;
  for (const CalibrationCell& cell : calibration.cells) {
    if (cell.alpha != alpha) continue;
    if (cell.method + cell.question != question) {
      question = cell.method + cell.question;
      table.heading(escape_xml(cell.method + ": " + cell.question));
    }
    const std::string n = cell.mistaken.runs == 0
                              ? ""
                              : count_text(static_cast<std::uint64_t>(cell.observations + 0.5));
    table.row({{escape_xml(cell.law), "name"},
               {rate_markup(cell.mistaken)},
               {share_markup(cell.invalid, cell.mistaken)},
               {share_markup(cell.inconclusive, cell.mistaken)},
               {rate_markup(cell.found)},
               {rate_markup(cell.missed)},
               {n},
               {chosen_markup(cell)},
               {rate_markup(cell.alone)},
               {share_markup(cell.red.count, cell.red)},
               {rate_markup(cell.alone_green)},
               {verdict_markup(calibration, cell)}});
  }
  return table.finish();
}

std::string fact(const char* label, const std::string& value) {
  return fmt::format("<span>{} <b>{}</b></span>\n", label, escape_xml(one_line(value)));
}

constexpr const char* help =
    R"html(<p>Mistaken: the whole procedure (pilot, choice of method, looks, gates) fails a claim that is true; of tost, passes one that is false. Alone: the method forced, all observations in one look, its gates shown and without effect: what a textbook test does. Limits are exact binomial ones that hold for all cells together. A procedure errs too often where its lower limit exceeds the tolerated multiple of alpha; where a method alone does, a gate must be red.</p>
)html";

}  // namespace

std::string html(const Calibration& calibration) {
  const std::string sentence = verdict_sentence(calibration);
  std::string out = page_head("Assay: calibration, " + sentence);
  out += fmt::format("<body>\n<h1 class=\"{}\">Calibration: {}</h1>\n",
                     defects(calibration) == 0 ? "passed" : "failed", escape_xml(sentence));
  out += "<div class=\"facts\">\n";
  out += fact("program", calibration.tool.name + " " + calibration.tool.version);
  out += fact("commit", calibration.tool.commit);
  out += fact("runs a cell", fmt::format("{}", calibration.runs));
  out += fact("seeds from", fmt::format("{}", calibration.seed));
  out += fact("detect", calibration.detect);
  out += fact("tolerated", fmt::format("{:g} alpha", calibration.tolerance));
  out += fact("limits wrong in any cell with probability", human(calibration.error));
  out += fact("started", calibration.started);
  out += fact("took", duration(calibration.seconds));
  out += std::string("</div>\n") + help;
  double alpha = 0;
  for (const CalibrationCell& cell : calibration.cells) {
    if (cell.alpha == alpha) continue;
    alpha = cell.alpha;
    out += fmt::format("<h2>alpha {:g}</h2>\n", alpha);
    out += figure(calibration_chart(calibration, alpha), "");
    out += table(calibration, alpha);
  }
  return out + "</body>\n</html>\n";
}

}  // namespace assay::reports
