#include <fmt/format.h>

#include "reports/viewer/charts.h"
#include "reports/viewer/html_parts.h"
#include "reports/viewer/html_table.h"
#include "reports/words/kill_matrix.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

std::string words(const std::string& text) { return escape_xml(one_line(text)); }

HtmlTable::Cell cell_of(const Suite& suite, std::size_t index,
                        const std::optional<KillCell>& cell) {
  if (!cell) return {};
  const Test& test = suite.tests[cell->test];
  return {.markup = fmt::format("<a href=\"#{}\">{}</a>", anchor({index, cell->test}),
                                words(sentence(suite, *cell))),
          .tooltip = fmt::format("{} ({})", test.claim, test.method)};
}

std::string table(const Suite& suite, std::size_t index, const KillMatrix& matrix) {
  std::vector<HtmlTable::Column> columns = {{"mutant"}, {"defect"}};
  for (const std::string& method : matrix.methods) columns.push_back({method});
  HtmlTable out(columns, "cards");
  for (const KillRow& row : matrix.rows) {
    const EstimatorSummary& mutant = suite.estimators[row.mutant];
    std::vector<HtmlTable::Cell> cells = {
        {source_markup(mutant.name, mutant.plugin, mutant.parameters), "name"},
        {words(fmt::format("{}: {}", mutant.original, mutant.defect))}};
    for (const auto& cell : row.cells) cells.push_back(cell_of(suite, index, cell));
    out.row(cells);
  }
  return out.finish();
}

}  // namespace

std::string kill_section(const Record& record, std::size_t index) {
  const Suite& suite = record.suites[index];
  const KillMatrix matrix = kill_matrix(suite);
  if (!is_worth_showing(matrix)) return {};
  return fmt::format(
      "<h3>Which method sees which defect</h3>\n<p>{}</p>\n<p class=\"muted\">{}</p>\n{}"
      "<details class=\"more\"><summary>The same in words, with the "
      "defects</summary>\n{}</details>\n",
      words(kill_totals(suite, matrix)), escape_xml(kill_matrix_legend),
      figure(kill_chart(suite, matrix), ""), table(suite, index, matrix));
}

}  // namespace assay::reports
