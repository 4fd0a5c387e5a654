#include "harness/ledger/ledger_reading.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace assay::harness {
namespace {

constexpr double zeta_3 = 1.2020569031595942;
constexpr double credibility = 0.9;

std::vector<stats::Evidence> evidence_of(const std::vector<LedgerNight>& nights) {
  std::vector<stats::Evidence> all;
  for (const LedgerNight& night : nights) all.push_back(night.evidence);
  return all;
}

/// The score about the nearest value that the claim allows.
stats::Evidence about(const ClaimedRange& claimed, const stats::Evidence& total) {
  const double nearest = std::clamp(total.score / total.information, claimed.low, claimed.high);
  return {total.score - total.information * nearest, total.information};
}

Moved moved_by_e(const std::vector<LedgerNight>& nights) {
  double since = 0;
  double best = -std::numeric_limits<double>::infinity();
  std::size_t start = 0;
  for (std::size_t i = nights.size(); i-- > 0;) {
    since += nights[i].log_e;
    if (since > best) {
      best = since;
      start = i;
    }
  }
  return {start, start, start};
}

}  // namespace

ClaimedRange claimed_range(const Regions& regions) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  switch (regions.relation) {
    case Relation::at_most:
    case Relation::less:
      return {-infinity, regions.allow};
    case Relation::at_least:
    case Relation::greater:
      return {-regions.allow, infinity};
    case Relation::within:
      return {-regions.within, regions.within};
    case Relation::equal:
      break;
  }
  return {-regions.allow, regions.allow};
}

std::vector<double> log_e_path(const LedgerSeries& series, const std::vector<LedgerNight>& nights,
                               const ClaimedRange& claimed) {
  std::vector<double> path;
  stats::Evidence total;
  double log_e = 0;
  for (const LedgerNight& night : nights) {
    if (series.kind == EvidenceKind::log_e) {
      log_e += night.log_e;
    } else {
      total += night.evidence;
      log_e = stats::log_e_value(about(claimed, total), series.prior);
    }
    path.push_back(log_e);
  }
  return path;
}

Moved moved(const LedgerSeries& series, const std::vector<LedgerNight>& nights) {
  if (series.kind == EvidenceKind::log_e) return moved_by_e(nights);
  const stats::ChangePoint change = stats::change_point(evidence_of(nights), series.prior);
  const std::vector<std::size_t> credible = stats::credible_nights(change, credibility);
  return {change.night, credible.front(), credible.back()};
}

double generation_share(int generation) { return 1 / (zeta_3 * std::pow(generation, 3)); }

}  // namespace assay::harness
