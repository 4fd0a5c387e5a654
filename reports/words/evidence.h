#pragma once

// Which p-value a verdict rests on, and what the others say.

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

/// How a claim relates its sides: the relation outside all brackets; empty where there is none.
std::string relation_of(const std::string& claim);

/// True for <, > and within: the claim passes when its contrary is rejected, so that the p-value of
/// the claim itself says little.
bool is_proof(const Test&);

/// "a >= b" for "a < b", "a not within x of b" for "a within x of b". Empty for a claim that is no
/// proof.
std::string contrary(const std::string& claim);

/// A p-value with the name that tells of what: "p", "p(contrary)", "p(claim)".
struct NamedP {
  std::string name;
  Number p, log10_p;
  bool exists() const { return p || log10_p; }
  std::string text() const;  ///< "p(contrary) = 1.5e-303"; empty where there is none
};

/// The worst channel's numbers, or those of an untested channel where nothing was tested.
Channel worst_channel(const Test&);

/// The channel that the verdict rests on. After a fail, or without a region to exclude, this is the
/// channel most against the claim. Else it is the channel whose forbidden region is excluded least.
Channel deciding_channel(const Test&);

/// The p-value that the verdict rests on: of the claim; in a proof that did not fail, of its
/// contrary, the largest over the channels.
NamedP headline_p(const Test&);

/// The other p-value: of an effect that must not pass, or of the claim that was not refuted.
NamedP other_p(const Test&);

/// Sentences on the two: how each was found and what it is held against.
std::string evidence_text(const Test&);
std::string exclusion_text(const Test&);

}  // namespace assay::reports
