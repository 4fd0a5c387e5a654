#include "harness/plan/repeated_images.h"

#include <fmt/format.h>

#include <cstring>
#include <set>
#include <span>
#include <string>

#include "harness/plan/independence.h"

namespace assay::harness {
namespace {

/// Order of images of one size by their bits.
struct ByBits {
  template <class Real>
  bool operator()(std::span<const Real> a, std::span<const Real> b) const {
    return std::memcmp(a.data(), b.data(), a.size_bytes()) < 0;
  }
};

std::size_t different_images(const Observations& images) {
  return std::visit(
      [](const auto& all) {
        using Real = std::remove_cvref_t<decltype(all[0][0])>;
        std::set<std::span<const Real>, ByBits> different;
        for (const auto& image : all) different.insert(std::span<const Real>(image));
        return different.size();
      },
      images);
}

}  // namespace

void note_repeated_images(const Question& question, const Pilots& pilots, Plan& plan) {
  std::set<std::string> seen;
  for (const Subject& subject : question.subjects) {
    const Pilot* pilot = pilot_of(subject, pilots);
    if (is_recorded(subject) || pilot == nullptr || pilot->image_count() < 2) continue;
    if (!seen.insert(pilot_name(subject)).second) continue;
    const std::size_t all = pilot->image_count();
    const std::size_t different = different_images(pilot->images);
    if (different == 1) {
      plan.hint += fmt::format(
          "; all {} images of `{}` in its pilot are alike: see that the seed "
          "changes the image",
          all, subject.estimator->name);
    }
    plan.gates.push_back(gate_of(
        reports::Gate{.name = fmt::format("different images of {}, pilot", subject.estimator->name),
                      .value = static_cast<double>(different),
                      .limit = static_cast<double>(all),
                      .state = different < all ? "amber" : "green"}));
  }
}

}  // namespace assay::harness
