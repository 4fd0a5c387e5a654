#include "reports/words/kill_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>

#include "reports/words/columns.h"
#include "reports/words/describe.h"
#include "reports/words/effect.h"
#include "reports/words/evidence.h"
#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

constexpr std::array textbook = {"t", "Welch", "chi-square", "F", "KS", "fit", "image"};

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

/// True if the first says more of the method than the second.
bool better(const Suite& suite, const KillCell& one, const KillCell& other) {
  if (one.fate != other.fate) return one.fate < other.fate;
  if (one.fate != Fate::survived) return one.samples < other.samples;
  constexpr double none = std::numeric_limits<double>::infinity();
  return found_from(suite.tests[one.test]).value_or(none) <
         found_from(suite.tests[other.test]).value_or(none);
}

std::string margin(const Test& test) {
  const Number least = found_from(test);
  if (!least || !std::isfinite(*least)) return {};
  const Effect& effect = worst_channel(test).effect;
  return is_ratio(effect) ? "×" + human(std::exp(std::min(*least, 700.0)), 3)
                          : magnitude(*least, effect.relative);
}

/// Columns that hold something: the textbook's in their order, then others as they come.
std::vector<std::string> columns_of(const std::vector<std::string>& found) {
  std::vector<std::string> columns;
  for (const char* name : textbook) {
    if (std::find(found.begin(), found.end(), name) != found.end()) columns.emplace_back(name);
  }
  for (const std::string& name : found) {
    if (std::find(columns.begin(), columns.end(), name) == columns.end()) columns.push_back(name);
  }
  return columns;
}

struct Tested {
  std::size_t mutant = 0;
  std::string column;
  KillCell cell;
};

std::vector<Tested> tested(const Suite& suite) {
  std::vector<Tested> all;
  for (std::size_t t = 0; t < suite.tests.size(); ++t) {
    const Test& test = suite.tests[t];
    const std::optional<std::size_t> mutant = mutant_of(suite, test);
    if (!mutant || test.verdict == Verdict::skipped) continue;
    all.push_back({.mutant = *mutant,
                   .column = column_of(test),
                   .cell = {.test = t,
                            .fate = fate_of(test),
                            .samples = samples_of(test, suite.estimators[*mutant].name)}});
  }
  return all;
}

bool is_kill(const std::optional<KillCell>& cell) {
  return cell && (cell->fate == Fate::killed || cell->fate == Fate::broken);
}

// ---- Lines of a terminal

constexpr int least_name = 16;
constexpr int most_name = 34;
constexpr int gap = 2;

struct Column {
  std::string heading;
  std::vector<std::string> cells;
  int width = 0;
};

Column column_of(const Suite& suite, const KillMatrix& matrix, std::size_t method) {
  Column column{.heading = one_line(matrix.methods[method])};
  column.width = columns(column.heading);
  for (const KillRow& row : matrix.rows) {
    const auto& cell = row.cells[method];
    column.cells.push_back(cell ? one_line(short_text(suite, *cell)) : std::string());
    column.width = std::max(column.width, columns(column.cells.back()));
  }
  return column;
}

std::vector<std::string> names_of(const Suite& suite, const KillMatrix& matrix) {
  std::vector<std::string> names;
  for (const KillRow& row : matrix.rows)
    names.push_back(one_line(suite.estimators[row.mutant].name));
  return names;
}

/// How many columns from the first on fit beside names of the least width, one at the least.
std::size_t fitting(const std::vector<Column>& all, std::size_t first, int width) {
  int used = least_name;
  std::size_t count = 0;
  while (first + count < all.size() &&
         (count == 0 || used + gap + all[first + count].width <= width)) {
    used += gap + all[first + count].width;
    ++count;
  }
  return count;
}

std::string right(const std::string& text, int width) {
  return std::string(static_cast<std::size_t>(std::max(0, width - columns(text))), ' ') + text;
}

/// Columns side by side, a name before each line.
class Block {
 public:
  Block(std::vector<std::string> names, std::span<const Column> columns_of_block, int width)
      : names_(std::move(names)), columns_(columns_of_block) {
    int room = width;
    for (const Column& column : columns_) room -= gap + column.width;
    for (const std::string& name : names_) name_width_ = std::max(name_width_, columns(name));
    name_width_ = std::min({name_width_, most_name, std::max(room, least_name)});
  }

  void write(std::vector<std::string>& lines) const {
    lines.push_back(line("mutant", [](const Column& column) { return column.heading; }));
    for (std::size_t r = 0; r < names_.size(); ++r) {
      const bool any = std::any_of(columns_.begin(), columns_.end(),
                                   [r](const Column& column) { return !column.cells[r].empty(); });
      if (any)
        lines.push_back(line(names_[r], [r](const Column& column) { return column.cells[r]; }));
    }
  }

 private:
  template <class Content>
  std::string line(const std::string& name, Content content) const {
    std::string text = pad_right(shorten(name, name_width_), name_width_);
    for (const Column& column : columns_)
      text += std::string(gap, ' ') + right(content(column), column.width);
    while (text.ends_with(' ')) text.pop_back();
    return text;
  }

  std::vector<std::string> names_;
  std::span<const Column> columns_;
  int name_width_ = 6;  ///< of the heading
};

}  // namespace

KillMatrix kill_matrix(const Suite& suite) {
  const std::vector<Tested> all = tested(suite);
  std::vector<std::string> found;
  for (const Tested& one : all) found.push_back(one.column);
  KillMatrix matrix{.methods = columns_of(found)};
  std::map<std::size_t, std::vector<std::optional<KillCell>>> rows;
  for (const Tested& one : all) {
    std::vector<std::optional<KillCell>>& cells = rows[one.mutant];
    cells.resize(matrix.methods.size());
    const auto column = std::find(matrix.methods.begin(), matrix.methods.end(), one.column);
    std::optional<KillCell>& cell =
        cells[static_cast<std::size_t>(column - matrix.methods.begin())];
    if (!cell || better(suite, one.cell, *cell)) cell = one.cell;
  }
  for (auto& [mutant, cells] : rows)
    matrix.rows.push_back({.mutant = mutant, .cells = std::move(cells)});
  return matrix;
}

bool is_worth_showing(const KillMatrix& matrix) {
  return std::any_of(matrix.rows.begin(), matrix.rows.end(), [](const KillRow& row) {
    return std::count_if(row.cells.begin(), row.cells.end(),
                         [](const auto& cell) { return cell.has_value(); }) > 1;
  });
}

std::string short_text(const Suite& suite, const KillCell& cell) {
  const Test& test = suite.tests[cell.test];
  if (cell.fate == Fate::killed) return count_text(cell.samples);
  if (cell.fate == Fate::broken) return "not finite";
  if (cell.fate == Fate::open) return test.verdict == Verdict::invalid ? "invalid" : "undecided";
  const std::string least = margin(test);
  return least.empty() ? "survives" : "< " + least;
}

std::string sentence(const Suite& suite, const KillCell& cell) {
  const Test& test = suite.tests[cell.test];
  const std::string samples = counted(cell.samples, "sample", "samples");
  if (cell.fate == Fate::killed) return "killed by " + samples;
  if (cell.fate == Fate::broken) return "not finite among " + samples;
  if (cell.fate == Fate::open) {
    return fmt::format("{} after {}", to_string(test.verdict), samples);
  }
  const std::string least = margin(test);
  return least.empty() ? "survives " + samples
                       : fmt::format("survives {}: an effect of {} or more would have been found",
                                     samples, least);
}

std::string kill_totals(const Suite& suite, const KillMatrix& matrix) {
  std::set<std::string> mutants, killed;
  std::vector<int> tested_by(matrix.methods.size()), killed_by(matrix.methods.size());
  for (const KillRow& row : matrix.rows) {
    const std::string& plugin = suite.estimators[row.mutant].plugin;
    mutants.insert(plugin);
    for (std::size_t m = 0; m < row.cells.size(); ++m) {
      tested_by[m] += row.cells[m].has_value() ? 1 : 0;
      killed_by[m] += is_kill(row.cells[m]) ? 1 : 0;
      if (is_kill(row.cells[m])) killed.insert(plugin);
    }
  }
  std::string text = fmt::format(
      "{} of {} mutants are killed. Rows that each method kills:", killed.size(), mutants.size());
  for (std::size_t m = 0; m < matrix.methods.size(); ++m) {
    text += fmt::format("{} {} {} of {}", m > 0 ? "," : "", matrix.methods[m], killed_by[m],
                        tested_by[m]);
  }
  return text + ".";
}

const char* const kill_matrix_legend =
    "A number: killed by so many samples (primary estimates drawn of the mutant; of an image, a "
    "pixel). < x: it survives, and an effect of x or more would have been found. Empty: not "
    "tested by that method. t and Welch compare means with a number and with another estimator, "
    "chi-square and F variances, KS laws of one coordinate, fit counts in cells, image all "
    "pixels; the pilot may put a method in their place that keeps its level.";

std::vector<std::string> kill_lines(const Suite& suite, const KillMatrix& matrix, int width) {
  std::vector<Column> all;
  for (std::size_t m = 0; m < matrix.methods.size(); ++m)
    all.push_back(column_of(suite, matrix, m));
  const std::vector<std::string> names = names_of(suite, matrix);
  std::vector<std::string> lines;
  for (std::size_t first = 0; first < all.size();) {
    const std::size_t count = fitting(all, first, width);
    Block(names, std::span<const Column>(all).subspan(first, count), width).write(lines);
    first += count;
  }
  return lines;
}

}  // namespace assay::reports
