#pragma once

// What tests take from the pilots: of two laws values that come again and again, and cells; of
// images the weights of their elements.

#include <vector>

#include "harness/plan/outcome.h"
#include "harness/question/pilot.h"

namespace assay::harness {

/// Whether the method cannot do without the pilots.
bool takes_from_pilot(const Method& method);

/// The samplers of a question of whose draws a pilot is wanted.
std::vector<const Subject*> piloted_draws(const Question& question);

/// The most frequent value of each channel, both sides' pilots together, where it is at least one
/// in a hundred of them: fewer ties cost Kolmogorov and Smirnov's test next to nothing. Nothing for
/// samplers, whose draws without a point are apart already.
std::vector<std::optional<Atom>> atoms_of(const Question& question, const Pilots& pilots,
                                          const Plan& plan);

/// Gives the plan's method what it takes from the pilots; `invalid` where they do not have it. Rows
/// of a file are their own pilot: those of both sides together, which tell nothing of who is who,
/// or, beside drawn values, none of them.
void freeze(const Question& question, const Pilots& pilots, Plan& plan);

/// Of a claim about laws: `two-part-ks` for two samples of which the pilots show an atom, unless
/// the test forces a method; then freezes.
void choose_for_laws(const Question& question, const Pilots& pilots, Plan& plan);

}  // namespace assay::harness
