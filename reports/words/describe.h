#pragma once

// A test in words, the same in every format: which p-value its verdict rests on, and its numbers.

#include <cstdint>
#include <string>
#include <vector>

#include "reports/record/record.h"

namespace assay::reports {

/// A claim about the relation that stands outside all brackets: a source may have one in its
/// parameters. Without a relation all of the claim is on the left.
struct Sides {
  std::string left, relation, right;
};
Sides sides_of(const std::string& claim);

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

/// A failed claim that pictures are equal is told by the place that differs most, if this place
/// rejects it. A proof is about all pixels together.
bool is_told_by_place(const Test&);

/// The effect that the sentence on a test shows: of the finding in an image that fails, else of the
/// deciding channel. Without an estimate where the sentence has no number.
Effect effect_in_sentence(const Test&);

/// The p-value that the verdict rests on: of the claim; in a proof that did not fail, of its
/// contrary, the largest over the channels.
NamedP headline_p(const Test&);

/// Sentences on this p-value, and on the other: of an effect that must not pass, or of the claim
/// that was not refuted. They say how each was found and what it is held against.
std::string evidence_text(const Test&);
std::string exclusion_text(const Test&);

/// The samples of the worst channel, and those of estimators that have none of its name.
std::vector<const Sample*> worst_samples(const Test&);

/// ✓ ✗ ? – for ok, not ok, undecided and not run, in one column.
std::string mark(Standing);

/// The verdict with what was expected of it, where that is not pass: "fail (as expected)",
/// "pass, but fail expected".
std::string verdict_text(const Test&);

/// The first number to look for in a test: the effect in its sentence, with the named interval.
/// Without an effect it is the p-value that the verdict rests on. Empty if nothing was tested.
std::string key_number(const Test&);

/// "1.05 M rays", or samples where no ray was traced.
std::string cost_text(const Cost&);
/// A claim on images without rays costs its number of pictures.
std::string cost_text(const Test&);
std::uint64_t rays(const Cost&);

/// "suites/triangle.yaml:14".
std::string place(const Test&);

/// The first sentence of the message, or what the verdict says by itself: a report's one line.
std::string headline(const Test&);

/// A label and a sentence.
struct Fact {
  std::string label, text;
  ASSAY_FIELDS(Fact, label, text)
};

/// Everything that a reader of a verdict needs, in reading order: claim, null hypothesis, estimate,
/// p-values, margins, expectation, channels, assumptions, message, cost, place.
std::vector<Fact> facts(const Test&);

/// The same facts as lines "label: sentence", with the replay command: for formats that show plain
/// text.
std::string plain_text(const Test&);

/// "alpha 0.01 (false alarms), beta 0.01 (misses), seed 1".
std::string levels_text(const Suite& suite);

}  // namespace assay::reports
