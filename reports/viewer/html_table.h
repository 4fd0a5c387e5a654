#pragma once

// Tables of the HTML page that fit every width: on a narrow screen each row becomes a list of
// labelled values. Not part of the public interface.

#include <string>
#include <vector>

namespace assay::reports {

class HtmlTable {
 public:
  struct Column {
    std::string label;
    bool number = false;  ///< set to the right, in figures of equal width
  };
  struct Cell {
    std::string markup;
    std::string style = {};
    std::string tooltip = {};
  };

  explicit HtmlTable(std::vector<Column> columns, const char* style = "");

  /// One cell a column; an empty one is left out where rows are lists.
  void row(const std::vector<Cell>& cells, const char* style = "");
  /// A heading above the rows that follow.
  void heading(const std::string& markup, const char* style = "");
  std::string finish();

 private:
  std::vector<Column> columns_;
  std::string out_;
};

}  // namespace assay::reports
