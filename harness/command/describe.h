#pragma once

#include <string>
#include <vector>

#include "estimators/estimator.h"

namespace assay::harness {

/// Columns of help, manuals and tables: 80, or those of a narrower terminal.
std::size_t page_width();

/// The manual of a plugin: what it estimates, its parameters, samplers, and mutants among
/// `entries`. Known values of its channels are those for default parameters. A line has at most
/// `page_width` columns, unless a word is longer.
std::string manual(const Entry& plugin, const std::vector<Entry>& entries);

/// The text in lines of at most `width` columns, each after `indent` blanks. Its line ends stay.
std::string wrapped(const std::string& text, std::size_t indent = 0,
                    std::size_t width = page_width());

/// Two columns of a page, the right one from `column` on. A left side that is too long has its own
/// line.
std::string beside(const std::string& left, const std::string& right, std::size_t column);

// The tables that a user can read: methods, quantities, laws, gates, reports.

struct TableRow {
  std::string name;
  std::string summary;
  std::string page;  ///< what else there is to say, as wide as a page

  bool operator==(const TableRow&) const = default;
};

struct Table {
  std::string plural;    ///< "methods"
  std::string singular;  ///< "a method"
  std::vector<TableRow> rows;
};

const std::vector<Table>& tables();

/// Names and summaries in two columns.
std::string text_of(const Table& table);

}  // namespace assay::harness
