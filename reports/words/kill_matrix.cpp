#include "reports/words/kill_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

#include "reports/words/describe.h"
#include "reports/words/number.h"

namespace assay::reports {
namespace {

constexpr std::array textbook = {"t", "Welch", "chi-square", "F", "KS", "fit", "image"};

constexpr const char* legend =
    "A number: this many samples kill the mutant (its primary estimates; for an image, per pixel). "
    "< x: it survives, and an effect of x or more would have been found. Empty: not tested by this "
    "method. t compares a mean with a number, Welch two means, chi-square and F variances, KS laws "
    "of one coordinate, fit counts in cells, image all pixels. The pilot may replace a method by "
    "one that keeps its level.";

/// The column of a test, by what it claims and of how many sources.
std::string method_of(const Test& test) {
  const std::string quantity = test.claim.substr(0, test.claim.find('('));
  if (test.image || test.method == "image") return "image";
  const bool of_two = worst_samples(test).size() > 1;
  if (quantity == "mean" || quantity == "bias") return of_two ? "Welch" : "t";
  if (quantity == "variance") return of_two ? "F" : "chi-square";
  if (quantity == "distribution") return test.method.starts_with("chi-square") ? "fit" : "KS";
  return quantity;
}

/// A mutant's place among the suite's estimators, and the sample that a test has of it.
struct Mutant {
  std::size_t place;
  const Sample* sample;
};

std::optional<Mutant> mutant_of(const Suite& suite, const Test& test) {
  for (const Sample& sample : test.samples) {
    for (std::size_t i = 0; i < suite.estimators.size(); ++i) {
      const EstimatorSummary& estimator = suite.estimators[i];
      if (estimator.name == sample.estimator && !estimator.original.empty())
        return Mutant{i, &sample};
    }
  }
  return std::nullopt;
}

/// A test's word on one mutant. A lesser rank says more of the method: a kill by few samples first,
/// what is undecided last.
struct Result {
  std::pair<int, double> rank;
  KillCell cell;
};

Result result_of(const Test& test, std::uint64_t count) {
  const std::string samples = counted(count, "sample", "samples");
  const auto drawn = static_cast<double>(count);
  const Verdict verdict = test.verdict;
  // An observation that was not finite is seen as well.
  const bool killed = verdict == Verdict::fail || verdict == Verdict::error;
  const auto result = [&](std::pair<int, double> rank, const std::string& text,
                          const std::string& sentence) {
    return Result{rank, {test.id, text, sentence, killed}};
  };
  if (verdict == Verdict::fail)
    return result({0, drawn}, count_text(count), "killed by " + samples);
  if (verdict == Verdict::error)
    return result({1, drawn}, "not finite", "not finite among " + samples);
  if (verdict != Verdict::pass)
    return result({3, drawn}, verdict == Verdict::invalid ? "invalid" : "undecided",
                  fmt::format("{} after {}", to_string(verdict), samples));
  const Number found = test.detectable ? test.detectable : test.detect;
  if (!is_finite(found))
    return result({2, std::numeric_limits<double>::infinity()}, "survives", "survives " + samples);
  const std::string least = margin_text(*found, worst_channel(test).effect);
  return result(
      {2, *found}, "< " + least,
      fmt::format("survives {}: an effect of {} or more would have been found", samples, least));
}

}  // namespace

KillMatrix kill_matrix(const Suite& suite) {
  KillMatrix matrix{.legend = legend};
  std::map<std::size_t, std::map<std::string, Result>> mutants;  // the best results by method
  for (const Test& test : suite.tests) {
    const std::optional<Mutant> mutant = mutant_of(suite, test);
    if (!mutant || test.verdict == Verdict::skipped) continue;
    const std::string method = method_of(test);
    const Result one = result_of(test, mutant->sample->primaries * mutant->sample->secondaries);
    const auto [best, is_first] = mutants[mutant->place].emplace(method, one);
    if (!is_first && one.rank < best->second.rank) best->second = one;
    if (std::ranges::find(matrix.methods, method) == matrix.methods.end())
      matrix.methods.push_back(method);
  }
  // The textbook's in their order, then others as they come.
  std::ranges::stable_sort(matrix.methods, {}, [](const std::string& method) {
    return std::ranges::find(textbook, method) - textbook.begin();
  });
  std::set<std::string> tested, killed;  // plugins counted once
  for (const auto& [mutant, best] : mutants) {
    const EstimatorSummary& estimator = suite.estimators[mutant];
    KillRow row{estimator.name, estimator.defect, {}};
    tested.insert(estimator.plugin);
    for (const std::string& method : matrix.methods) {
      const auto one = best.find(method);
      row.cells.push_back(one == best.end() ? std::optional<KillCell>() : one->second.cell);
      if (one != best.end() && one->second.cell.killed) killed.insert(estimator.plugin);
    }
    matrix.rows.push_back(std::move(row));
  }
  std::vector<std::string> by_method;
  for (std::size_t m = 0; m < matrix.methods.size(); ++m) {
    const auto is_tested = [m](const KillRow& row) { return row.cells[m].has_value(); };
    const auto is_killed = [m](const KillRow& row) { return row.cells[m] && row.cells[m]->killed; };
    by_method.push_back(fmt::format(" {} {} of {}", matrix.methods[m],
                                    std::ranges::count_if(matrix.rows, is_killed),
                                    std::ranges::count_if(matrix.rows, is_tested)));
  }
  matrix.totals = fmt::format("{} of {} mutants are killed. Rows that each method kills:{}.",
                              killed.size(), tested.size(), fmt::join(by_method, ","));
  return matrix;
}

bool is_worth_showing(const KillMatrix& matrix) {
  return std::ranges::any_of(matrix.rows, [](const KillRow& row) {
    return std::ranges::count(row.cells, true, &std::optional<KillCell>::has_value) > 1;
  });
}

}  // namespace assay::reports
