#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "reports/viewer/charts.h"
#include "reports/viewer/svg.h"
#include "reports/words/kill_matrix.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

constexpr double full_width = 985;
constexpr double row_height = 20;
constexpr double header = 22;
constexpr double legend_height = 34;
constexpr double most_labels = 300;
constexpr double widest_cell = 130;

struct Shade {
  std::uint64_t below;  ///< samples
  const char* style;
  const char* label;
};

// A decade of samples is a step: the more it takes to see a defect, the paler.
constexpr std::array<Shade, 6> shades = {{{1000, "kill k0", "below 1 k"},
                                          {10'000, "kill k1", "10 k"},
                                          {100'000, "kill k2", "100 k"},
                                          {1'000'000, "kill k3", "1 M"},
                                          {10'000'000, "kill k4", "10 M"},
                                          {UINT64_MAX, "kill k5", "more samples"}}};

const char* style_of(const KillCell& cell) {
  if (cell.fate == Fate::broken) return shades.front().style;
  if (cell.fate != Fate::killed) return "cell unclear";
  return std::find_if(shades.begin(), shades.end() - 1,
                      [&](const Shade& shade) { return cell.samples < shade.below; })
      ->style;
}

class Chart {
 public:
  Chart(const Suite& suite, const KillMatrix& matrix) : suite_(suite), matrix_(matrix) {
    for (const KillRow& row : matrix.rows)
      labels_ = std::max(labels_, text_width(one_line(name(row))) + 12);
    labels_ = std::min(labels_, most_labels);
    cell_ =
        std::min((full_width - labels_) / static_cast<double>(matrix.methods.size()), widest_cell);
  }

  std::string draw() const {
    const double bottom = header + row_height * static_cast<double>(matrix_.rows.size());
    const double width = labels_ + cell_ * static_cast<double>(matrix_.methods.size()) + 4;
    Svg svg({std::max(width, labels_ + legend_width), bottom + legend_height},
            fmt::format("Kill matrix of {}. {} The table after this picture has every cell.",
                        suite_.name, kill_totals(suite_, matrix_)));
    for (std::size_t m = 0; m < matrix_.methods.size(); ++m) heading(svg, m);
    for (std::size_t r = 0; r < matrix_.rows.size(); ++r) row(svg, r);
    legend(svg, bottom + 12);
    return svg.finish();
  }

 private:
  static constexpr double legend_step = 96;
  static constexpr double legend_width = legend_step * static_cast<double>(shades.size()) + 4;

  const std::string& name(const KillRow& row) const { return suite_.estimators[row.mutant].name; }

  double left(std::size_t method) const { return labels_ + cell_ * static_cast<double>(method); }

  void heading(Svg& svg, std::size_t method) const {
    svg.text({.at = {left(method) + cell_ / 2, header - 7},
              .content = matrix_.methods[method],
              .anchor = Anchor::middle,
              .style = "title",
              .room = cell_ - 4});
  }

  void row(Svg& svg, std::size_t index) const {
    const KillRow& row = matrix_.rows[index];
    const EstimatorSummary& mutant = suite_.estimators[row.mutant];
    const double top = header + row_height * static_cast<double>(index);
    svg.text({.at = {labels_ - 8, top + 14},
              .content = mutant.name,
              .anchor = Anchor::end,
              .style = "mutant",
              .room = labels_ - 10,
              .tooltip = fmt::format("{}, a mutant of {}: {}", mutant.plugin, mutant.original,
                                     mutant.defect)});
    for (std::size_t m = 0; m < row.cells.size(); ++m) {
      if (row.cells[m]) cell(svg, *row.cells[m], {left(m), top, cell_, row_height}, mutant.name);
    }
  }

  void cell(Svg& svg, const KillCell& cell, const Box& box, const std::string& mutant) const {
    const Test& test = suite_.tests[cell.test];
    svg.box(
        box, style_of(cell),
        fmt::format("{}: {} ({}, {})", mutant, sentence(suite_, cell), test.claim, test.method));
    svg.text({.at = {box.x + box.width / 2, box.y + 14},
              .content = short_text(suite_, cell),
              .anchor = Anchor::middle,
              .style = "over",
              .room = box.width});
  }

  void legend(Svg& svg, double top) const {
    for (std::size_t i = 0; i < shades.size(); ++i) {
      const Box box{labels_ + legend_step * static_cast<double>(i), top, legend_step, 18};
      svg.box(box, shades[i].style);
      svg.text({.at = {box.x + box.width / 2, top + 13},
                .content = i == 0 || i + 1 == shades.size() ? shades[i].label
                                                            : fmt::format("to {}", shades[i].label),
                .anchor = Anchor::middle,
                .style = "over",
                .room = box.width});
    }
  }

  const Suite& suite_;
  const KillMatrix& matrix_;
  double labels_ = 90;
  double cell_ = 0;
};

}  // namespace

std::string kill_chart(const Suite& suite, const KillMatrix& matrix) {
  return is_worth_showing(matrix) ? Chart(suite, matrix).draw() : std::string();
}

}  // namespace assay::reports
