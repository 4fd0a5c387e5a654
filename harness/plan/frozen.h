#pragma once

// Data that tests take from the pilots: atoms and cells of two laws, weights of images' elements.

#include <vector>

#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"

namespace assay::harness {

/// True if the method needs the pilots.
bool takes_from_pilot(const Method& method);

/// The most frequent value of each channel in both sides' pilots, if it makes up 1 % or more. Fewer
/// ties hardly cost Kolmogorov and Smirnov's test. Empty for samplers, whose draws without a point
/// are kept apart already.
std::vector<std::optional<Atom>> atoms_of(const Question& question, const Pilots& pilots,
                                          const Plan& plan);

// A value counts as an atom from this share of the pilots' values on.
inline constexpr double least_atom = 0.01;

/// True if a channel has an atom.
bool has_atom(const std::vector<std::optional<Atom>>& atoms);

/// Gives the plan's method what it takes from the pilots; sets `invalid` if they lack it. Rows of a
/// file are their own pilot, both sides together; beside drawn values they are not used.
void freeze(const Question& question, const Pilots& pilots, Plan& plan);

}  // namespace assay::harness
