#pragma once

// The keys of a calibration's JSON, in their order. Not part of the public interface.

#include "reports/record/calibration.h"
#include "reports/record/fields.h"

namespace assay::reports {

template <class Archive, maybe_const<Rate> T>
void fields(Archive& a, T& rate) {
  a("count", rate.count);
  a("runs", rate.runs);
  a("low", rate.low);
  a("high", rate.high);
}

/// A method, and the number of runs that it judged.
struct ChosenMethod {
  std::string method;
  std::uint64_t runs;
};

template <class Archive, maybe_const<ChosenMethod> T>
void fields(Archive& a, T& chosen) {
  a("method", chosen.method);
  a("runs", chosen.runs);
}

template <class Archive, maybe_const<VerdictRates> T>
void fields(Archive& a, T& rates) {
  std::vector<ChosenMethod> by;
  for (const auto& [method, runs] : rates.by) by.push_back({method, runs});
  a("pass", rates.pass);
  a("fail", rates.fail);
  a("inconclusive", rates.inconclusive);
  a("invalid", rates.invalid);
  a("red", rates.red);
  a("observations", rates.observations);
  a("by", by);
}

template <class Archive, maybe_const<CalibrationCell> T>
void fields(Archive& a, T& cell) {
  a("method", cell.method);
  a("question", cell.question);
  a("law", cell.law);
  a("alpha", cell.alpha);
  a("proof", cell.proof);
  a("holds", cell.holds);
  a("off", cell.off);
  a("alone", cell.alone);
  a("alone_not_red", cell.alone_not_red);
}

template <class Archive, maybe_const<Calibration> T>
void fields(Archive& a, T& calibration) {
  const std::string kind = "calibration";
  a("report", kind);
  a("tool", calibration.tool);
  a("environment", calibration.environment);
  a("seed", calibration.seed);
  a("runs", calibration.runs);
  a("started", calibration.started);
  a("seconds", calibration.seconds);
  a("tolerance", calibration.tolerance);
  a("error", calibration.error);
  a("detect", calibration.detect);
  a("cells", calibration.cells);
}

}  // namespace assay::reports
