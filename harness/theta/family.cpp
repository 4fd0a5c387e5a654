#include "harness/theta/family.h"

#include <algorithm>
#include <limits>

namespace assay::harness {
namespace {

bool inside_family(const Question& question) {
  if (question.test->expect != reports::Verdict::pass) return false;
  return std::ranges::none_of(question.subjects, [](const Subject& s) {
    return !s.estimator->entry->information.original.empty();
  });
}

}  // namespace

std::vector<FamilyPlace> places(const Suite& suite, const std::vector<Question>& questions) {
  std::vector<FamilyPlace> all;
  double inside_weight = 0;
  double all_weight = 0;
  int outside = 0;
  const auto timed = [](const std::optional<Budget>& budget) { return budget && budget->seconds; };
  for (const Question& question : questions) {
    const bool inside = inside_family(question);
    all.push_back(
        {.inside = inside, .in_seconds = timed(suite.budget) || timed(question.test->budget)});
    all_weight += question.test->weight;
    if (inside) inside_weight += question.test->weight;
    if (!inside) ++outside;
  }
  // A test whose source died keeps its part: the others' numbers do not change.
  double least_untested = std::numeric_limits<double>::infinity();
  for (const TestEntry& test : suite.tests) {
    const auto asks = [&](const Question& question) { return question.test == &test; };
    if (std::ranges::any_of(questions, asks)) continue;
    all_weight += test.weight;
    if (test.expect != reports::Verdict::pass) {
      ++outside;
      continue;
    }
    inside_weight += test.weight;
    least_untested = std::min(least_untested, test.weight);
  }
  const double total = inside_weight > 0 ? inside_weight : all_weight;
  double smallest = suite.alpha * least_untested / total;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double weight =
        questions[i].test->weight / total / static_cast<double>(questions[i].channel_count());
    all[i].weight = all[i].inside ? weight : 0;
    all[i].share = {.alpha = suite.alpha * weight, .beta = suite.beta};
    if (all[i].inside || inside_weight == 0) smallest = std::min(smallest, all[i].share.alpha);
  }
  for (FamilyPlace& place : all) {
    if (!place.inside) place.share = {.alpha = smallest, .beta = suite.beta / outside};
  }
  return all;
}

}  // namespace assay::harness
