#pragma once

// The rows of options make all that users read and complete of the command line.

#include <string>
#include <vector>

namespace assay::harness {

/// The place of an option in the line that repeats a test. What changes no number is `nowhere`. So
/// are suites, seed and selection, since the record adds each test's own.
enum class Replay { first, middle, last, nowhere };

/// An option or an argument of a command.
struct OptionText {
  std::string name;                ///< "--seed"; an argument's is without dashes.
  std::string value = "";          ///< "N|random"; of an argument what the usage line shows.
  Replay replay = Replay::middle;  ///< An argument stands first, or nowhere.
  std::string needed = "";         ///< What a message says is needed; "" if it may be left out.
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

}  // namespace assay::harness
