#pragma once

#include <string>
#include <vector>

#include "estimators/estimator.h"

namespace assay::harness {

/// The manual of a plugin: what it estimates, its parameters, samplers, and mutants among
/// `entries`. Known values of its channels are those for default parameters. Lines have at most 100
/// columns, unless a word is longer.
std::string manual(const Entry& plugin, const std::vector<Entry>& entries);

/// The text in lines of at most `width` columns, each after `indent` blanks. Its line ends stay.
std::string wrapped(const std::string& text, std::size_t width, std::size_t indent);

// The tables that a user can read: methods, quantities, laws, gates, reports.

struct TableRow {
  std::string name;
  std::string summary;
  std::string page;  ///< what else there is to say, lines of at most 80 columns

  bool operator==(const TableRow&) const = default;
};

struct Table {
  std::string plural;    ///< "methods"
  std::string singular;  ///< "a method"
  std::vector<TableRow> rows;
};

const std::vector<Table>& tables();

/// Names and summaries in two columns, 80 columns wide.
std::string text_of(const Table& table);

}  // namespace assay::harness
