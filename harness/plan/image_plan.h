#pragma once

// Planning claims on images.

#include <cstdint>
#include <optional>

#include "harness/pilot/pilot.h"
#include "harness/plan/outcome.h"

namespace assay::harness {

/// Replicates of a claim on images without `detect`.
inline constexpr std::uint64_t classical_replicates = 64;

/// True if `detect` or `within` determines the replicates.
bool plans_replicates(const Question& question);

/// Returns the replicates of the first look.
std::uint64_t choose_for_image(const Question& question, const Pilots& pilots, std::uint64_t most,
                               Plan& plan);

/// Replicates that exclude `detect` or prove `within` if the images are equal; nullopt without
/// either or without pilots.
std::optional<std::uint64_t> image_secondaries(const Question& question, const ErrorShare& share,
                                               const Plan& plan);

/// Why so few replicates are no test; "" if they are enough.
std::string too_few_replicates(const Question& question, const Plan& plan);

}  // namespace assay::harness
