#include "harness/pilot/pilot_run.h"

#include <algorithm>

#include "harness/theta/method.h"
#include "harness/theta/methods.h"

namespace assay::harness {
namespace {

/// Estimators whose costs some claim is about.
std::set<std::string> costly(const std::vector<Question>& questions) {
  std::set<std::string> names;
  for (const Question& question : questions) {
    if (methods_for(question).front().keeps != Keeps::costs) continue;
    for (const Subject& subject : question.subjects) names.insert(subject.estimator->name);
  }
  return names;
}

// Enough to tell an excess kurtosis of .5 from a normal law's, even if a claim asks for fewer.
constexpr std::uint64_t least_of_larger = 2048;

/// The most observations that a claim on variance or cost asks for, by estimator. References are
/// left out: only their mean is used.
std::map<std::string, std::uint64_t> on_tails(const std::vector<Question>& questions) {
  std::map<std::string, std::uint64_t> most;
  for (const Question& question : questions) {
    if (!question.is().rests_on_tails) continue;
    for (std::size_t i = 0; i < question.compared(); ++i) {
      std::uint64_t& size = most[question.subjects[i].estimator->name];
      size =
          std::max({size, least_of_larger, question.test->secondaries.value_or(many_observations)});
    }
  }
  return most;
}

}  // namespace

std::vector<const Subject*> piloted_draws(const Question& question) {
  std::vector<const Subject*> draws;
  if (!question.is().pilots_draws) return draws;
  for (const Subject& side : question.subjects) {
    if (!side.purpose.empty()) draws.push_back(&side);
  }
  return draws;
}

PilotRun pilot_run_of(const std::vector<Question>& questions, const std::vector<bool>& chosen,
                      std::uint64_t seed, unsigned threads) {
  PilotRun run{.seed = seed, .threads = threads, .with_cost = costly(questions)};
  const std::map<std::string, std::uint64_t> most = on_tails(questions);
  for (std::size_t i = 0; i < questions.size(); ++i) {
    if (!chosen[i]) continue;
    for (const Subject* subject : piloted_draws(questions[i])) run.draws.push_back(subject);
    if (!questions[i].is().rests_on_tails) continue;
    for (const Subject& subject : questions[i].subjects) {
      const auto found = most.find(subject.estimator->name);
      if (found != most.end()) run.on_tails.insert(*found);
    }
  }
  return run;
}

PilotRun pilot_run_of(const std::vector<Question>& questions, std::uint64_t seed,
                      unsigned threads) {
  return pilot_run_of(questions, std::vector<bool>(questions.size(), true), seed, threads);
}

}  // namespace assay::harness
