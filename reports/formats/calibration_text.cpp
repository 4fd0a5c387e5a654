// Calibrations for a terminal and as Markdown.

#include <fmt/format.h>

#include <algorithm>

#include "reports/record/calibration.h"
#include "reports/words/columns.h"
#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

std::string rate_text(const Rate& rate) {
  return rate.runs == 0 ? "" : fmt::format("{:.3g}", rate.value());
}

std::string share_text(std::uint64_t count, const Rate& of) {
  if (of.runs == 0) return "";
  return fmt::format("{:.2g}", static_cast<double>(count) / static_cast<double>(of.runs));
}

std::string low_text(const Rate& rate) {
  return rate.runs == 0 ? "" : fmt::format("{:.2g}", rate.low);
}

std::string observations_text(double count) {
  return count == 0 ? "" : count_text(static_cast<std::uint64_t>(count + 0.5));
}

std::string chosen_text(const CalibrationCell& cell) {
  return cell.chosen.empty() ? "" : cell.chosen[0].first;
}

struct Column {
  const char* heading;
  int width;
  std::string (*text)(const CalibrationCell&);
};

// Mark and law take 21 columns.
const std::vector<Column>& table_columns() {
  static const std::vector<Column> all{
      {"mistaken", 9, [](const CalibrationCell& c) { return rate_text(c.mistaken); }},
      {"at least", 9, [](const CalibrationCell& c) { return low_text(c.mistaken); }},
      {"invalid", 8, [](const CalibrationCell& c) { return share_text(c.invalid, c.mistaken); }},
      {"open", 6, [](const CalibrationCell& c) { return share_text(c.inconclusive, c.mistaken); }},
      {"power", 6, [](const CalibrationCell& c) { return rate_text(c.found); }},
      {"n", 7, [](const CalibrationCell& c) { return observations_text(c.observations); }},
      {"by", 21, chosen_text},
      {"alone", 7, [](const CalibrationCell& c) { return rate_text(c.alone); }},
      {"red", 6, [](const CalibrationCell& c) { return share_text(c.red.count, c.red); }},
  };
  return all;
}

std::string padded(const std::string& text, int width) {
  return std::string(static_cast<std::size_t>(std::max(1, width - columns(text))), ' ') + text;
}

const char* mark_of(const Calibration& calibration, const CalibrationCell& cell) {
  if (above(calibration, cell)) return "!! ";
  return unflagged(calibration, cell) ? "!  " : "   ";
}

std::string console_row(const Calibration& calibration, const CalibrationCell& cell) {
  std::string line = mark_of(calibration, cell) + pad_right(shorten(cell.law, 18), 18);
  for (const Column& column : table_columns()) line += padded(column.text(cell), column.width);
  return line + "\n";
}

std::string heading_row() {
  std::string line(21, ' ');
  for (const Column& column : table_columns()) line += padded(column.heading, column.width);
  return line + "\n";
}

constexpr const char* legend =
    R"(mistaken  runs in which the whole procedure fails a true claim (of tost: passes a false one)
at least  the exact lower limit of that        open  inconclusive        n  mean observations
power     right verdicts where the effect is `detect`; empty where no such runs are made
by        the method that most runs are judged by
alone     the method forced, in one look, gates without effect        red  with a red gate
!!  mistaken too often for certain        !  alone mistaken too often for certain without a red gate
)";

std::string wrapped_detect(const Calibration& calibration) {
  std::string out;
  for (const std::string& line : wrap("detect    " + calibration.detect, 100)) out += line + "\n";
  return out;
}

}  // namespace

std::string console(const Calibration& calibration) {
  std::string out;
  double alpha = 0;
  std::string group;
  for (const CalibrationCell& cell : calibration.cells) {
    if (cell.alpha != alpha) {
      alpha = cell.alpha;
      group.clear();
      out += fmt::format("{}alpha {:g}: {} runs a cell, seeds from {}\n", out.empty() ? "" : "\n",
                         alpha, calibration.runs, calibration.seed);
      out += heading_row();
    }
    if (cell.method + cell.question != group) {
      group = cell.method + cell.question;
      out += fmt::format("{}: {}\n", cell.method, cell.question);
    }
    out += console_row(calibration, cell);
  }
  return out + "\n" + legend + wrapped_detect(calibration) + "\n" + verdict_sentence(calibration) +
         "\n";
}

std::string markdown(const Calibration& calibration) {
  std::string out = fmt::format("# Calibration: {}\n\n{} runs a cell, seeds from {}\n",
                                verdict_sentence(calibration), calibration.runs, calibration.seed);
  double alpha = 0;
  for (const CalibrationCell& cell : calibration.cells) {
    if (cell.alpha != alpha) {
      alpha = cell.alpha;
      out += fmt::format("\n## alpha {:g}\n\n| method | question | law |", alpha);
      for (const Column& column : table_columns()) out += fmt::format(" {} |", column.heading);
      out += "\n|---|---|---|";
      for (std::size_t i = 0; i < table_columns().size(); ++i) out += "---|";
      out += "\n";
    }
    out +=
        fmt::format("| {}{} | {} | {} |", mark_of(calibration, cell), escape_markdown(cell.method),
                    escape_markdown(cell.question), escape_markdown(cell.law));
    for (const Column& column : table_columns()) out += fmt::format(" {} |", column.text(cell));
    out += "\n";
  }
  return out + "\n```\n" + legend + wrapped_detect(calibration) + "```\n";
}

}  // namespace assay::reports
