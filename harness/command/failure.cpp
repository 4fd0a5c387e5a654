#include "harness/command/failure.h"

#include <algorithm>

#include "estimators/core/line_error.h"
#include "harness/base/text_file.h"
#include "harness/suite/suite.h"
#include "reports/words/text.h"

namespace assay::harness {
namespace {

constexpr int message_width = 80;

/// The end of the piece that begins at `begin`: the next blank outside backticks.
std::size_t end_of_piece(const std::string& text, std::size_t begin) {
  std::size_t end = begin;
  for (bool quoted = false; end < text.size() && (quoted || text[end] != ' '); ++end) {
    // A backtick that is never closed does not quote.
    if (text[end] == '`') quoted = !quoted && text.find('`', end + 1) != std::string::npos;
  }
  return end;
}

/// The text after `lead`; further lines are indented as deep.
std::string wrapped_message(const std::string& text, const std::string& lead) {
  std::string out;
  std::string line = lead;
  bool is_new = true;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = end_of_piece(text, begin);
    const std::string piece = text.substr(begin, end - begin);
    if (!is_new && reports::columns(line + " " + piece) > message_width) {
      out += line + "\n";
      line = std::string(lead.size(), ' ');
      is_new = true;
    }
    line += (is_new ? "" : " ") + piece;
    is_new = false;
    begin = end + 1;
  }
  return out + line + "\n";
}

}  // namespace

std::string in_lines(const std::string& sentence) {
  const std::size_t end = std::min(sentence.find('\n'), sentence.size());
  std::string out = wrapped_message(sentence.substr(0, end), "assay: ");
  // Text that already has lines, such as another program's, keeps them.
  if (end < sentence.size()) out += sentence.substr(end + 1) + "\n";
  return out;
}

std::string failure_text(const InputError& error, const std::string& claim) {
  const Location& where = error.where();
  const bool in_claim = where.file == "claim" && where.line == 1 && !claim.empty();
  const auto* const with_line = dynamic_cast<const LineError*>(&error);
  return in_lines(reports::clean(error.what())) +
         (with_line != nullptr ? caret_below(with_line->line(), where.column)
          : in_claim           ? caret_below(claim, where.column)
                               : excerpt(where));
}

}  // namespace assay::harness
