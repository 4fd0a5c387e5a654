#pragma once

// The tables that a user can read: methods, quantities, laws, gates, reports.

#include <string>
#include <vector>

namespace assay::harness {

struct TableRow {
  std::string name;
  std::string summary;
  std::string page;  ///< what else there is to say, lines of at most 80 columns
};

struct Table {
  std::string plural;    ///< "methods"
  std::string singular;  ///< "a method"
  std::vector<TableRow> rows;
};

const std::vector<Table>& tables();

/// Names and summaries in two columns, 80 columns wide.
std::string text_of(const Table& table);

/// The pages of all rows of that name; "" where there is none.
std::string pages_of(const std::string& name);

}  // namespace assay::harness
