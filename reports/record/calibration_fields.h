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

template <class Archive, maybe_const<CalibrationCell> T>
void fields(Archive& a, T& cell) {
  std::vector<ChosenMethod> chosen;
  for (const auto& [method, runs] : cell.chosen) chosen.push_back({method, runs});
  a("method", cell.method);
  a("question", cell.question);
  a("law", cell.law);
  a("alpha", cell.alpha);
  a("proof", cell.proof);
  a("mistaken", cell.mistaken);
  a("inconclusive", cell.inconclusive);
  a("invalid", cell.invalid);
  a("observations", cell.observations);
  a("chosen", chosen);
  a("found", cell.found);
  a("missed", cell.missed);
  a("alone", cell.alone);
  a("alone_red", cell.red);
  a("alone_green", cell.alone_green);
  a("alone_observations", cell.alone_observations);
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
