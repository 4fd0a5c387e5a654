#pragma once

// Planning claims on images.

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/plan/outcome.h"
#include "harness/question/pilot.h"

namespace assay::harness {

/// Replicates of a claim on images without `detect`.
inline constexpr std::uint64_t classical_replicates = 64;

/// The replicates that a claim without `detect` or `within` is planned for, of so many at most.
std::uint64_t usual_replicates(const Question& question, std::uint64_t most);
/// Whether something asks for more or fewer of them.
bool plans_replicates(const Question& question);

/// Weights of the elements in sums over cells: from the pilot, whose images are more than a test's
/// and not its own. Empty where they are its own, rows of a file: there halves weigh each other.
std::vector<double> image_weights(const Question& question, const Pilots& pilots, const Plan& plan);

/// Which cells take part: none so small that the pilot's skewness would raise their share of false
/// alarms by more than a quarter (mean over the cells of a size). Notes the gates. Returns the
/// replicates of the first look: in looks as many, up to 1024, as the whole image's sum needs to
/// keep its level.
std::uint64_t choose_for_image(const Question& question, const FamilyPlace& place,
                               const Pilots& pilots, std::uint64_t most, Plan& plan);

/// Replicates that exclude `detect` (or prove `within`) where the images are equal; nullopt where
/// nothing asks for a number.
std::optional<std::uint64_t> image_secondaries(const Question& question, const ErrorShare& share,
                                               const Pilots& pilots, const Plan& plan);

/// Why so few replicates are no test; "" where they are enough.
std::string too_few_replicates(const Question& question, const Plan& plan);

}  // namespace assay::harness
