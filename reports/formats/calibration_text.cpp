// Calibrations for a terminal and as Markdown.

#include <fmt/format.h>

#include <algorithm>

#include "reports/record/calibration.h"
#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

std::string rate_text(const Rate& rate) { return fmt::format("{:.3g}", rate.value()); }

/// One of a cell's claims: a line of the table.
struct ClaimLine {
  const char* claim;
  const VerdictRates* rates;
  const Rate* mistaken;  ///< null if no verdict on this claim errs against alpha
};

std::vector<ClaimLine> lines_of(const CalibrationCell& cell) {
  std::vector<ClaimLine> lines;
  for (const ClaimLine& line :
       {ClaimLine{"holds", &cell.holds, cell.proof ? nullptr : &cell.mistaken()},
        ClaimLine{"off", &cell.off, cell.proof ? &cell.mistaken() : nullptr},
        ClaimLine{"alone", &cell.alone, &cell.alone_mistaken()}}) {
    if (line.rates->runs() > 0) lines.push_back(line);
  }
  return lines;
}

/// A line of the table, which stands below its law.
template <class... Cells>
std::string row(const Cells&... cells) {
  return fmt::format("{:>7} {:>6} {:>6} {:>6} {:>7} {:>7} {:>5} {:>7} {:>20}\n", cells...);
}

std::string row_of(const ClaimLine& line) {
  const VerdictRates& rates = *line.rates;
  return row(line.claim, rate_text(rates.pass), rate_text(rates.fail),
             rate_text(rates.inconclusive), rate_text(rates.invalid),
             line.mistaken == nullptr ? "" : fmt::format("{:.2g}", line.mistaken->low),
             rates.red.count == 0 ? "" : fmt::format("{:.2g}", rates.red.value()),
             count_text(static_cast<std::uint64_t>(rates.observations + 0.5)),
             rates.by.empty() ? "" : rates.by.front().method);
}

constexpr const char* legend =
    R"(holds   the claim holds exactly        off  the claim is off by `detect`
alone   this method forced, in one look, its warnings (gates) ignored
open    inconclusive        red  with a red gate        n  mean observations
by      the method that judges most runs
errs    the rate of mistakes is at least this. A mistake is a true claim that
        fails; for tost and other proofs, a claim off by `detect` that passes
!!  mistaken too often for certain
!   alone mistaken too often for certain, without a red gate
)";

}  // namespace

bool above(const Calibration& calibration, const CalibrationCell& cell) {
  return cell.mistaken().low > calibration.tolerance * cell.alpha;
}

bool unflagged(const Calibration& calibration, const CalibrationCell& cell) {
  return cell.alone_not_red.low > calibration.tolerance * cell.alpha;
}

std::size_t defects(const Calibration& calibration) {
  const auto errs = [&](const CalibrationCell& cell) {
    return above(calibration, cell) || unflagged(calibration, cell);
  };
  return static_cast<std::size_t>(std::ranges::count_if(calibration.cells, errs));
}

std::string verdict_sentence(const Calibration& calibration) {
  const std::size_t bad = defects(calibration);
  if (bad == 0)
    return fmt::format("no cell of {} is found to err too often", calibration.cells.size());
  return fmt::format("{} of {} cells err too often", bad, calibration.cells.size());
}

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
      out += row("claim", "pass", "fail", "open", "invalid", "errs", "red", "n", "by");
    }
    if (cell.method + cell.question != group) {
      group = cell.method + cell.question;
      out += fmt::format("{}: {}\n", cell.method, cell.question);
    }
    out += above(calibration, cell) ? "!! " : unflagged(calibration, cell) ? "!  " : "   ";
    out += cell.law + "\n";
    for (const ClaimLine& line : lines_of(cell)) out += row_of(line);
  }
  return fmt::format("{}\n{}{}\n\n{}\n", out, legend,
                     fmt::join(wrap("detect    " + calibration.detect, 80), "\n"),
                     verdict_sentence(calibration));
}

std::string markdown(const Calibration& calibration) {
  return fmt::format("# Calibration: {}\n\n```\n{}```\n", verdict_sentence(calibration),
                     console(calibration));
}

}  // namespace assay::reports
