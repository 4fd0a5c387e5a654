#pragma once

// The rows of options make all that users read and complete of the command line.

#include <string>
#include <vector>

#include "estimators/estimator.h"

namespace assay::harness {

/// The line that repeats a test keeps the options that change its numbers. Suites, seed and
/// selection are left out, since the record adds each test's own.
enum class Replay { no, yes };

/// An option or an argument of a command.
struct OptionText {
  std::string name;        ///< "--seed"; an argument's is without dashes.
  std::string value = "";  ///< "N|random"; of an argument what the usage line shows.
  Replay replay = Replay::yes;
  std::string needed = "";  ///< A message says that it is needed; "" if it may be left out.
  std::vector<std::string> words = {};  ///< Completion offers them; a `*` stands for files.
  std::string about = "";
  bool repeats = false;

  bool is_argument() const { return !name.starts_with('-'); }
  bool takes_value() const { return !is_argument() && !value.empty(); }
};

struct CommandText {
  std::string name;
  std::string summary;  ///< a line in the list of commands
  std::string about;    ///< what it does, then examples
  std::vector<OptionText> options;
};

/// `assay --help`: the first hour, in 24 lines of 80 columns.
std::string overview(const std::vector<CommandText>& commands);
/// The page on claims, a text in Markdown, in lines of 80 columns.
std::string help_of_claims(std::string_view markdown);
/// `assay help all`.
std::string help_of_all(const std::vector<CommandText>& commands);
/// `assay COMMAND --help`, in lines of `page_width`.
std::string help_of(const CommandText& command);
/// assay.1, in the language of man pages.
std::string man_page(const std::vector<CommandText>& commands);

/// Lists what may stand in the place of the last of the words after `assay`. Each line has a word,
/// a tab and its description.
std::string completions(const std::vector<CommandText>& commands,
                        const std::vector<std::string>& words);

// ---- Manuals

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

/// Prints the page of a plugin, or those of the tables' rows of that name.
int describe(const std::string& name);

}  // namespace assay::harness
