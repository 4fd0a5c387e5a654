#include "reports/words/kill_text.h"

#include <algorithm>
#include <span>

#include "reports/words/columns.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

constexpr int least_name = 16;
constexpr int most_name = 34;
constexpr int gap = 2;

struct Column {
  std::string heading;
  std::vector<std::string> cells;
  int width = 0;
};

Column column_of(const Suite& suite, const KillMatrix& matrix, std::size_t method) {
  Column column{.heading = one_line(matrix.methods[method]), .cells = {}};
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
