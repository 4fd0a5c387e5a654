#include "reports/viewer/html_table.h"

#include <fmt/format.h>

#include "reports/words/text.h"

namespace assay::reports {
namespace {

std::string attribute(const char* name, const std::string& value) {
  return value.empty() ? std::string() : fmt::format(" {}=\"{}\"", name, escape_attribute(value));
}

std::string joined(const std::string& first, const std::string& second) {
  return first.empty() || second.empty() ? first + second : first + " " + second;
}

}  // namespace

HtmlTable::HtmlTable(std::vector<Column> columns, const char* style)
    : columns_(std::move(columns)),
      out_(fmt::format("<div class=\"scroll\"><table{}>\n<thead><tr>", attribute("class", style))) {
  for (const Column& column : columns_)
    out_ += fmt::format("<th{}>{}</th>", attribute("class", column.number ? "number" : ""),
                        escape_xml(column.label));
  out_ += "</tr></thead>\n<tbody>\n";
}

void HtmlTable::row(const std::vector<Cell>& cells, const char* style) {
  out_ += fmt::format("<tr{}>", attribute("class", style));
  for (std::size_t i = 0; i < cells.size() && i < columns_.size(); ++i) {
    const Cell& cell = cells[i];
    std::string styles = joined(columns_[i].number ? "number" : "", cell.style);
    if (cell.markup.empty()) styles = joined(styles, "empty");
    out_ += fmt::format("<td{}{}{}>{}</td>", attribute("class", styles),
                        attribute("data-label", columns_[i].label),
                        attribute("title", cell.tooltip), cell.markup);
  }
  out_ += "</tr>\n";
}

void HtmlTable::heading(const std::string& markup, const char* style) {
  out_ += fmt::format("</tbody>\n<tbody>\n<tr{}><th class=\"group\" colspan=\"{}\">{}</th></tr>\n",
                      attribute("class", style), columns_.size(), markup);
}

std::string HtmlTable::finish() { return out_ + "</tbody></table></div>\n"; }

}  // namespace assay::reports
