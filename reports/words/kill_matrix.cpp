#include "reports/words/kill_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/algorithm/string/join.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "reports/words/describe.h"
#include "reports/words/number.h"

namespace assay::reports {
namespace {

constexpr std::array textbook = {"t", "Welch", "chi-square", "F", "KS", "fit", "image"};

constexpr const char* legend =
    "A number: killed by so many samples (primary estimates drawn of the mutant; of an image, a "
    "pixel). < x: it survives, and an effect of x or more would have been found. Empty: not "
    "tested by that method. t and Welch compare means with a number and with another estimator, "
    "chi-square and F variances, KS laws of one coordinate, fit counts in cells, image all "
    "pixels; the pilot may put a method in their place that keeps its level.";

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

Number found_from(const Test& test) { return test.detectable ? test.detectable : test.detect; }

/// A test's word on one mutant.
struct Tested {
  const Test* test;
  std::uint64_t samples;

  /// An observation that was not finite is seen as well.
  bool kills() const { return test->verdict == Verdict::fail || test->verdict == Verdict::error; }
};

/// Less of a result that says more of the method: a kill by few samples first, what is undecided
/// last.
std::pair<int, double> rank(const Tested& one) {
  constexpr double none = std::numeric_limits<double>::infinity();
  const auto samples = static_cast<double>(one.samples);
  switch (one.test->verdict) {
    case Verdict::fail:
      return {0, samples};
    case Verdict::error:
      return {1, samples};
    case Verdict::pass:
      return {2, found_from(*one.test).value_or(none)};
    default:
      return {3, samples};
  }
}

KillCell cell_of(const Tested& one) {
  const std::string samples = counted(one.samples, "sample", "samples");
  const auto cell = [&](const std::string& text, const std::string& sentence) {
    return KillCell{one.test->id, text, sentence, one.kills()};
  };
  const Verdict verdict = one.test->verdict;
  if (verdict == Verdict::fail) return cell(count_text(one.samples), "killed by " + samples);
  if (verdict == Verdict::error) return cell("not finite", "not finite among " + samples);
  if (verdict != Verdict::pass)
    return cell(verdict == Verdict::invalid ? "invalid" : "undecided",
                fmt::format("{} after {}", to_string(verdict), samples));
  if (!is_finite(found_from(*one.test))) return cell("survives", "survives " + samples);
  const std::string least = margin_text(*found_from(*one.test), worst_channel(*one.test).effect);
  return cell(
      "< " + least,
      fmt::format("survives {}: an effect of {} or more would have been found", samples, least));
}

/// The best results on a mutant by method.
using Best = std::map<std::string, Tested>;

/// The mutants that were tested, and those that some method killed, plugins counted once.
struct Plugins {
  std::set<std::string> tested, killed;
};

std::string totals_of(const KillMatrix& matrix, const Plugins& plugins) {
  std::vector<std::string> rows;
  for (std::size_t m = 0; m < matrix.methods.size(); ++m) {
    const auto tested = [m](const KillRow& row) { return row.cells[m].has_value(); };
    const auto killed = [m](const KillRow& row) { return row.cells[m] && row.cells[m]->killed; };
    rows.push_back(fmt::format(" {} {} of {}", matrix.methods[m],
                               std::ranges::count_if(matrix.rows, killed),
                               std::ranges::count_if(matrix.rows, tested)));
  }
  return fmt::format("{} of {} mutants are killed. Rows that each method kills:{}.",
                     plugins.killed.size(), plugins.tested.size(), boost::join(rows, ","));
}

}  // namespace

KillMatrix kill_matrix(const Suite& suite) {
  KillMatrix matrix{.legend = legend};
  std::map<std::size_t, Best> mutants;
  for (const Test& test : suite.tests) {
    const std::optional<Mutant> mutant = mutant_of(suite, test);
    if (!mutant || test.verdict == Verdict::skipped) continue;
    const std::string method = method_of(test);
    const Tested one{&test, mutant->sample->primaries * mutant->sample->secondaries};
    const auto [best, is_first] = mutants[mutant->place].emplace(method, one);
    if (!is_first && rank(one) < rank(best->second)) best->second = one;
    if (std::ranges::find(matrix.methods, method) == matrix.methods.end())
      matrix.methods.push_back(method);
  }
  // The textbook's in their order, then others as they come.
  std::ranges::stable_sort(matrix.methods, {}, [](const std::string& method) {
    return std::ranges::find(textbook, method) - textbook.begin();
  });
  Plugins plugins;
  for (const auto& [mutant, best] : mutants) {
    const EstimatorSummary& estimator = suite.estimators[mutant];
    KillRow row{estimator.name, estimator.defect, {}};
    plugins.tested.insert(estimator.plugin);
    for (const std::string& method : matrix.methods) {
      const auto one = best.find(method);
      row.cells.push_back(one == best.end() ? std::optional<KillCell>() : cell_of(one->second));
      if (one != best.end() && one->second.kills()) plugins.killed.insert(estimator.plugin);
    }
    matrix.rows.push_back(std::move(row));
  }
  matrix.totals = totals_of(matrix, plugins);
  return matrix;
}

bool is_worth_showing(const KillMatrix& matrix) {
  return std::ranges::any_of(matrix.rows, [](const KillRow& row) {
    return std::ranges::count(row.cells, true, &std::optional<KillCell>::has_value) > 1;
  });
}

}  // namespace assay::reports
