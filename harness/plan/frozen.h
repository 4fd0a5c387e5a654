#pragma once

// Data that tests take from the pilots: atoms and cells of two laws, weights of images' elements.

#include <vector>

#include "harness/plan/outcome.h"
#include "harness/question/pilot.h"

namespace assay::harness {

/// True if the method needs the pilots.
bool takes_from_pilot(const Method& method);

/// The samplers of a question whose draws need a pilot.
std::vector<const Subject*> piloted_draws(const Question& question);

/// The most frequent value of each channel in both sides' pilots, if it makes up 1 % or more. Fewer
/// ties hardly cost Kolmogorov and Smirnov's test. Empty for samplers, whose draws without a point
/// are kept apart already.
std::vector<std::optional<Atom>> atoms_of(const Question& question, const Pilots& pilots,
                                          const Plan& plan);

/// Gives the plan's method what it takes from the pilots; sets `invalid` if they lack it. Rows of a
/// file are their own pilot, both sides together; beside drawn values they are not used.
void freeze(const Question& question, const Pilots& pilots, Plan& plan);

/// Chooses `two-part-ks` for two samples whose pilots show an atom, unless the test forces a
/// method; then freezes.
void choose_for_laws(const Question& question, const Pilots& pilots, Plan& plan);

}  // namespace assay::harness
