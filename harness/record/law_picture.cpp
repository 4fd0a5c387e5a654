#include "harness/record/law_picture.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <optional>

#include "harness/families/law_evidence.h"
#include "stats/laws/distribution_band.h"
#include "stats/means/binomial.h"

namespace assay::harness {
namespace {

constexpr std::size_t curve_parts = 64;

/// Cached: it takes tenths of a second, and tests of one suite ask for the same values.
double pointwise_error(std::uint64_t n, double confidence) {
  static std::mutex once;
  static std::map<std::pair<std::uint64_t, double>, double> known;
  constexpr std::uint64_t limit_from = 1001;  // the value is constant from there on
                                              // (distribution_band.h)
  const std::scoped_lock lock(once);
  const auto [place, added] = known.try_emplace({std::min(n, limit_from), confidence});
  if (added) place->second = stats::simultaneous_error(n, curve_parts, confidence);
  return place->second;
}

reports::EmpiricalLaw empirical_law(const Points& points, double confidence,
                                    const std::optional<DeclaredLaw>& law) {
  reports::EmpiricalLaw drawn{.confidence = confidence};
  const std::vector<double>& sorted = points.sorted;
  const std::uint64_t n = sorted.size();
  // An error below a double's resolution of 1 has no band.
  if (n < 2 || !(confidence < 1)) return drawn;
  const double gamma = pointwise_error(n, confidence);
  std::uint64_t before = 0;
  for (std::size_t i = 1; i < curve_parts; ++i) {
    const std::uint64_t rank = i * n / curve_parts;
    if (rank <= before) continue;
    const double value = sorted[rank - 1];
    // The end of a group of equal values.
    const auto end = std::upper_bound(sorted.begin(), sorted.end(), value);
    before = static_cast<std::uint64_t>(end - sorted.begin());
    const stats::Interval band = stats::clopper_pearson({before, n}, 1 - gamma);
    drawn.points.push_back({.value = value,
                            .observed = static_cast<double>(before) / static_cast<double>(n),
                            .low = band.low,
                            .high = band.high});
    if (law) drawn.points.back().law = law->law.cdf(value);
  }
  return drawn;
}

bool is_drawn(const TestOutcome& outcome) {
  return outcome.question.is().of_a_law && outcome.plan.method.keeps == Keeps::values;
}

}  // namespace

std::vector<reports::EmpiricalLaw> empirical_laws(const DrawnTest& test, std::size_t channel) {
  std::vector<reports::EmpiricalLaw> laws;
  const Question& question = test.outcome.question;
  if (!is_drawn(test.outcome)) return laws;
  std::optional<DeclaredLaw> law;
  if (!question.of_two()) law = declared_law(question, channel);
  const double confidence = 1 - test.outcome.share().alpha;
  const std::vector<ChannelData> data = data_of(test, channel);
  for (std::size_t subject = 0; subject < data.size(); ++subject) {
    laws.push_back(empirical_law(points_of(question, subject, channel, data[subject].values),
                                 confidence, law));
    laws.back().source = question.subjects[subject].estimator->listed;
  }
  return laws;
}

}  // namespace assay::harness
