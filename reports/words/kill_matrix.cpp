#include "reports/words/kill_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

/// The word before the first bracket of a claim: "mean", "variance", "slope".
std::string quantity_of(const std::string& claim) { return claim.substr(0, claim.find('(')); }

/// The column of a test, by what it claims and of how many sources.
std::string column_of(const Test& test) {
  const std::string quantity = quantity_of(test.claim);
  if (test.image || test.method == "image") return "image";
  const bool of_two = worst_samples(test).size() > 1;
  if (quantity == "mean" || quantity == "bias") return of_two ? "Welch" : "t";
  if (quantity == "variance") return of_two ? "F" : "chi-square";
  if (quantity == "distribution") return test.method.starts_with("chi-square") ? "fit" : "KS";
  return quantity;
}

std::optional<std::size_t> mutant_of(const Suite& suite, const Test& test) {
  for (const Sample& sample : test.samples) {
    for (std::size_t i = 0; i < suite.estimators.size(); ++i) {
      const EstimatorSummary& estimator = suite.estimators[i];
      if (estimator.name == sample.estimator && !estimator.original.empty()) return i;
    }
  }
  return std::nullopt;
}

/// The fate of a mutant under one method.
enum class Fate {
  killed,    ///< the claim was refuted
  broken,    ///< an observation was not finite, which is seen as well
  survived,  ///< no evidence against the claim
  open       ///< undecided, or no valid test
};

Fate fate_of(const Test& test) {
  if (test.verdict == Verdict::fail) return Fate::killed;
  if (test.verdict == Verdict::error) return Fate::broken;
  return test.verdict == Verdict::pass ? Fate::survived : Fate::open;
}

std::uint64_t samples_of(const Test& test, const std::string& mutant) {
  for (const Sample& sample : test.samples) {
    if (sample.estimator == mutant) return sample.primaries * sample.secondaries;
  }
  return 0;
}

Number found_from(const Test& test) { return test.detectable ? test.detectable : test.detect; }

/// A test's word on one mutant.
struct Tested {
  const Test* test;
  std::size_t mutant;  ///< in the suite's estimators
  std::string column;
  Fate fate;
  std::uint64_t samples;

  bool kills() const { return fate == Fate::killed || fate == Fate::broken; }
};

/// True if the first says more of the method than the second.
bool better(const Tested& one, const Tested& other) {
  if (one.fate != other.fate) return one.fate < other.fate;
  if (one.fate != Fate::survived) return one.samples < other.samples;
  constexpr double none = std::numeric_limits<double>::infinity();
  return found_from(*one.test).value_or(none) < found_from(*other.test).value_or(none);
}

std::string margin(const Test& test) {
  const Number least = found_from(test);
  if (!least || !std::isfinite(*least)) return {};
  const Effect& effect = worst_channel(test).effect;
  return is_ratio(effect) ? "×" + human(std::exp(std::min(*least, 700.0)), 3)
                          : magnitude(*least, effect.relative);
}

/// Columns that hold something: the textbook's in their order, then others as they come.
std::vector<std::string> columns_of(const std::vector<Tested>& all) {
  std::vector<std::string> columns;
  for (const char* name : textbook) {
    if (std::ranges::find(all, name, &Tested::column) != all.end()) columns.emplace_back(name);
  }
  for (const Tested& one : all) {
    if (std::ranges::find(columns, one.column) == columns.end()) columns.push_back(one.column);
  }
  return columns;
}

std::vector<Tested> tested(const Suite& suite) {
  std::vector<Tested> all;
  for (const Test& test : suite.tests) {
    const std::optional<std::size_t> mutant = mutant_of(suite, test);
    if (!mutant || test.verdict == Verdict::skipped) continue;
    all.push_back({.test = &test,
                   .mutant = *mutant,
                   .column = column_of(test),
                   .fate = fate_of(test),
                   .samples = samples_of(test, suite.estimators[*mutant].name)});
  }
  return all;
}

std::string short_text(const Tested& one) {
  if (one.fate == Fate::killed) return count_text(one.samples);
  if (one.fate == Fate::broken) return "not finite";
  if (one.fate == Fate::open)
    return one.test->verdict == Verdict::invalid ? "invalid" : "undecided";
  const std::string least = margin(*one.test);
  return least.empty() ? "survives" : "< " + least;
}

std::string sentence(const Tested& one) {
  const std::string samples = counted(one.samples, "sample", "samples");
  if (one.fate == Fate::killed) return "killed by " + samples;
  if (one.fate == Fate::broken) return "not finite among " + samples;
  if (one.fate == Fate::open)
    return fmt::format("{} after {}", to_string(one.test->verdict), samples);
  const std::string least = margin(*one.test);
  return least.empty() ? "survives " + samples
                       : fmt::format("survives {}: an effect of {} or more would have been found",
                                     samples, least);
}

/// The best results by mutant, one a method.
using Best = std::map<std::size_t, std::vector<const Tested*>>;

std::string totals_of(const Suite& suite, const std::vector<std::string>& methods,
                      const Best& best) {
  std::set<std::string> mutants, killed;
  std::vector<int> tested_by(methods.size()), killed_by(methods.size());
  for (const auto& [mutant, cells] : best) {
    const std::string& plugin = suite.estimators[mutant].plugin;
    mutants.insert(plugin);
    for (std::size_t m = 0; m < cells.size(); ++m) {
      if (cells[m] == nullptr) continue;
      ++tested_by[m];
      if (!cells[m]->kills()) continue;
      ++killed_by[m];
      killed.insert(plugin);
    }
  }
  std::string text = fmt::format(
      "{} of {} mutants are killed. Rows that each method kills:", killed.size(), mutants.size());
  for (std::size_t m = 0; m < methods.size(); ++m) {
    text += fmt::format("{} {} {} of {}", m > 0 ? "," : "", methods[m], killed_by[m], tested_by[m]);
  }
  return text + ".";
}

}  // namespace

KillMatrix kill_matrix(const Suite& suite) {
  const std::vector<Tested> all = tested(suite);
  KillMatrix matrix{.methods = columns_of(all), .legend = legend};
  Best best;
  for (const Tested& one : all) {
    std::vector<const Tested*>& cells = best[one.mutant];
    cells.resize(matrix.methods.size());
    const auto column = std::ranges::find(matrix.methods, one.column) - matrix.methods.begin();
    const Tested*& cell = cells[static_cast<std::size_t>(column)];
    if (cell == nullptr || better(one, *cell)) cell = &one;
  }
  for (const auto& [mutant, cells] : best) {
    KillRow row{suite.estimators[mutant].name, suite.estimators[mutant].defect, {}};
    for (const Tested* one : cells) {
      if (one == nullptr) {
        row.cells.emplace_back();
      } else {
        row.cells.push_back(
            KillCell{one->test->id, short_text(*one), sentence(*one), one->kills()});
      }
    }
    matrix.rows.push_back(std::move(row));
  }
  matrix.totals = totals_of(suite, matrix.methods, best);
  return matrix;
}

bool is_worth_showing(const KillMatrix& matrix) {
  return std::any_of(matrix.rows.begin(), matrix.rows.end(), [](const KillRow& row) {
    return std::count_if(row.cells.begin(), row.cells.end(),
                         [](const auto& cell) { return cell.has_value(); }) > 1;
  });
}

}  // namespace assay::reports
