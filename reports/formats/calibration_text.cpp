// Calibrations for a terminal and as Markdown.

#include <fmt/format.h>

#include <algorithm>

#include "reports/record/calibration.h"
#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

std::string rate_text(const Rate& rate) { return fmt::format("{:.3g}", rate.value()); }

/// A line of the table, which stands below its law.
template <class... Cells>
std::string row(const Cells&... cells) {
  return fmt::format("{:>7} {:>6} {:>6} {:>6} {:>7} {:>7} {:>5} {:>7} {:>20}\n", cells...);
}

/// A line for each of a cell's claims.
std::string rows_of(const CalibrationCell& cell) {
  struct Claim {
    const char* name;
    const VerdictRates& rates;
    const Rate* mistaken;  // null if no verdict on this claim errs against alpha
  };
  std::string text;
  for (const auto& [name, rates, mistaken] :
       {Claim{"holds", cell.holds, cell.proof ? nullptr : &cell.mistaken()},
        Claim{"off", cell.off, cell.proof ? &cell.mistaken() : nullptr},
        Claim{"alone", cell.alone, &cell.alone_mistaken()}}) {
    if (rates.runs() == 0) continue;
    text += row(name, rate_text(rates.pass), rate_text(rates.fail), rate_text(rates.inconclusive),
                rate_text(rates.invalid),
                mistaken == nullptr ? "" : fmt::format("{:.2g}", mistaken->low),
                rates.red.count == 0 ? "" : fmt::format("{:.2g}", rates.red.value()),
                count_text(static_cast<std::uint64_t>(rates.observations + 0.5)),
                rates.by.empty() ? "" : rates.by.front().method);
  }
  return text;
}

constexpr const char* legend =
    R"(holds   the claim holds exactly        off  the claim is off by `detect`
alone   this method forced, in one look, its warnings (gates) ignored
open    inconclusive      red  an assumption violated      n  mean observations
by      the method that judges most runs
errs    at least this part of the runs errs: a true claim fails or, for tost
        and other proofs, a claim off by `detect` passes
!!  mistaken too often for certain
!   alone mistaken too often for certain, with no assumption violated
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
    out += cell.law + "\n" + rows_of(cell);
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
