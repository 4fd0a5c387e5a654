#pragma once

// Planning claims on images.

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"

namespace assay::harness {

/// Replicates of a claim on images without `detect`.
inline constexpr std::uint64_t classical_replicates = 64;

/// The replicates that the test asks for, else the fewest if it plans them, else the classical
/// ones; at most `most`.
std::uint64_t usual_replicates(const Question& question, std::uint64_t most);
/// True if `detect` or `within` determines the replicates.
bool plans_replicates(const Question& question);

/// Weights of the elements in sums over cells, from the pilot. Empty for rows of a file, which are
/// their own pilot: there halves weigh each other.
std::vector<double> image_weights(const Question& question, const Pilots& pilots, const Plan& plan);

/// Chooses the cells that take part, and notes the gates. A size takes part if the pilot's skewness
/// raises its mean false alarms by a quarter at most. Returns the replicates of the first look: in
/// looks as many (1024 at most) as the whole image's sum needs to keep its level.
std::uint64_t choose_for_image(const Question& question, const FamilyPlace& place,
                               const Pilots& pilots, std::uint64_t most, Plan& plan);

/// Replicates that exclude `detect` or prove `within` if the images are equal; nullopt without
/// either or without pilots.
std::optional<std::uint64_t> image_secondaries(const Question& question, const ErrorShare& share,
                                               const Pilots& pilots, const Plan& plan);

/// Why so few replicates are no test; "" if they are enough.
std::string too_few_replicates(const Question& question, const Plan& plan);

}  // namespace assay::harness
