#include "harness/plan/secondaries.h"

#include <algorithm>
#include <cmath>

#include "estimators/ready_made.h"
#include "harness/plan/critical.h"

namespace assay::harness {

std::uint64_t largest_look(const Question& question, std::uint64_t most) {
  return std::min(most, question.test->secondaries.value_or(most));
}

std::uint64_t fewest_secondaries(const Question& question, std::uint64_t look) {
  std::uint64_t fewest = look;
  for (const Subject& side : question.subjects) fewest = std::min(fewest, side.secondaries(look));
  return fewest;
}

double times_the_fewest(const Question& question, std::size_t subject, std::uint64_t look) {
  return static_cast<double>(question.subjects[subject].secondaries(look)) /
         static_cast<double>(fewest_secondaries(question, look));
}

stats::SampleSizes sizes_of(const Question& question, std::uint64_t look) {
  const auto taken = [&](std::size_t subject) {
    return static_cast<double>(question.subjects[subject].secondaries(look));
  };
  return {.x = taken(0), .y = taken(question.of_two() ? 1 : 0)};
}

std::uint64_t secondaries_of_floor(const Question& question, const Plan& plan) {
  std::uint64_t floor = least_secondaries;
  for (std::size_t i = 0; i < question.subjects.size(); ++i) {
    const Setup& setup = *question.subjects[i].setup;
    if (setup.observations() || setup.image() || recorded::keeps_files(setup)) continue;
    const std::uint64_t each = std::max<std::uint64_t>(1, plan.primaries[i]);
    floor = std::max(floor, (floor_of_evidence + each - 1) / each);
  }
  return floor;
}

std::uint64_t whole_secondaries(double count) {
  return count < 0x1p53 ? static_cast<std::uint64_t>(std::ceil(count)) : impossible_secondaries;
}

}  // namespace assay::harness
