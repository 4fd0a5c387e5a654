#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "reports/viewer/charts.h"
#include "reports/viewer/svg.h"
#include "reports/words/columns.h"
#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

constexpr double full_width = 985;
constexpr double widest_cell = 100;
constexpr double wordy_cell = 84;  // wide enough for "no evidence"
constexpr double header = 22;

using Pairs = std::map<std::pair<std::string, std::string>, Comparison>;

// The comparison of a pair in the order asked for: a ratio turns round with its pair.
Pairs pairs_of(const Suite& suite, const std::string& channel) {
  Pairs pairs;
  for (const Comparison& comparison : suite.comparisons) {
    if (comparison.channel != channel) continue;
    pairs.insert_or_assign({comparison.first, comparison.second}, comparison);
    Comparison turned = comparison;
    std::swap(turned.first, turned.second);
    if (turned.variance_ratio) turned.variance_ratio = 1 / *turned.variance_ratio;
    pairs.insert_or_assign({turned.first, turned.second}, turned);
  }
  return pairs;
}

struct Standing {
  const char* style;
  const char* symbol;
  const char* word;
  std::string number;
};

Standing mean_standing(const Comparison& pair) {
  const std::string p = fmt::format("p {}", p_text(pair.mean_p, pair.log10_mean_p));
  if (pair.means_differ) return {"cell differ", "≠", "≠ differ", p};
  return {"cell agree", "=", "= agree", p};
}

Standing variance_standing(const Comparison& pair) {
  if (pair.mean_p && !pair.variance_p) return {"cell", "", "not compared", "units differ"};
  const Number ratio = pair.variance_ratio;
  const std::string times = ratio ? human(*ratio, 3) + "×" : std::string(no_number);
  if (!pair.variances_differ || !ratio) return {"cell unclear", "·", "no evidence", times};
  if (*ratio < 1) return {"cell smaller", "<", "< smaller", times};
  return {"cell larger", ">", "> larger", times};
}

class Matrix {
 public:
  Matrix(const Suite& suite, const std::string& channel) : pairs_(pairs_of(suite, channel)) {
    for (const EstimatorSummary& estimator : suite.estimators) {
      if (names_.size() < most_in_matrix) names_.push_back(estimator.name);
    }
    for (const std::string& name : names_)
      labels_ = std::min(std::max(labels_, text_width(one_line(name)) + 30), 210.0);
    cell_.width =
        std::clamp((full_width - labels_) / static_cast<double>(names_.size()), 19.0, widest_cell);
    wordy_ = cell_.width >= wordy_cell;
    cell_.height = wordy_ ? 36 : 20;
  }

  std::string draw(const Suite& suite) const {
    const auto n = static_cast<double>(names_.size());
    Svg svg({labels_ + n * cell_.width + 4, header + n * cell_.height + 4},
            fmt::format("Pairs of estimators of {}: means above the diagonal, variances below",
                        suite.name));
    for (std::size_t i = 0; i < names_.size(); ++i) heading(svg, i);
    for (std::size_t row = 0; row < names_.size(); ++row) {
      for (std::size_t column = 0; column < names_.size(); ++column) cell(svg, row, column);
    }
    return svg.finish();
  }

  bool worth_drawing() const { return names_.size() > 1 && !pairs_.empty(); }

 private:
  Box place(std::size_t row, std::size_t column) const {
    return {labels_ + static_cast<double>(column) * cell_.width,
            header + static_cast<double>(row) * cell_.height, cell_.width, cell_.height};
  }

  void heading(Svg& svg, std::size_t i) const {
    const Box box = place(i, i);
    svg.text({.at = {labels_ - 8, box.y + box.height / 2 + 4},
              .content = fmt::format(
                  "{} {}",
                  shorten(one_line(names_[i]), static_cast<int>((labels_ - 30) / text_width("m"))),
                  i + 1),
              .anchor = Anchor::end,
              .tooltip = names_[i]});
    svg.text({.at = {box.x + box.width / 2, header - 7},
              .content = wordy_ ? fmt::format("{} {}", i + 1, names_[i]) : fmt::format("{}", i + 1),
              .anchor = Anchor::middle,
              .room = box.width - 4,
              .tooltip = names_[i]});
  }

  void cell(Svg& svg, std::size_t row, std::size_t column) const {
    const Box box = place(row, column);
    const auto found = pairs_.find({names_[row], names_[column]});
    if (row == column || found == pairs_.end()) {
      svg.box(box, row == column ? "cell diagonal" : "cell");
      return;
    }
    const bool means = column > row;
    const Standing standing =
        means ? mean_standing(found->second) : variance_standing(found->second);
    svg.box(box, standing.style,
            fmt::format("{} of {} against {}: {}, {}", means ? "mean" : "variance", names_[row],
                        names_[column], standing.word, standing.number));
    const double middle = box.x + box.width / 2;
    const auto write = [&](double y, const std::string& text) {
      svg.text({.at = {middle, y},
                .content = text,
                .anchor = Anchor::middle,
                .style = "over",
                .room = box.width});
    };
    if (wordy_) {
      write(box.y + 15, standing.word);
      write(box.y + 30, standing.number);
    } else {
      write(box.y + 14, standing.symbol);
    }
  }

  Pairs pairs_;
  std::vector<std::string> names_;
  double labels_ = 90;
  Size cell_;
  bool wordy_ = false;
};

}  // namespace

std::string pair_matrix(const Suite& suite, const std::string& channel) {
  const Matrix matrix(suite, channel);
  return matrix.worth_drawing() ? matrix.draw(suite) : std::string();
}

}  // namespace assay::reports
