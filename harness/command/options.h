#pragma once

// Rows of options, and readers of their values. CLI11's options, the texts of help.h, the typed
// values and the words of the replay line are made from the rows. Only options.cpp includes CLI11,
// which compiles slowly.

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "harness/command/commands.h"
#include "harness/command/help.h"
#include "harness/record/record_of.h"
#include "harness/suite/yaml.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace assay::harness {

using Texts = std::vector<std::string>;

class Options {
 public:
  explicit Options(CLI::App& app) : app_(app) {}

  /// An option or an argument, which repeats if the target is a list. `read` takes the text and the
  /// option's name. An empty text counts as none if the option does not repeat.
  template <class Target, class Read>
  void add(OptionText name, Target& target, Read read, const std::string& about) {
    constexpr bool repeats = requires { target.emplace_back(); };
    if constexpr (requires { read.words(); }) name.words = read.words();
    add_row(name, about, repeats, [&target, read, option = name.name](const std::string& text) {
      if constexpr (repeats) {
        target.push_back(read(text, option));
      } else {
        target = read(text, option);
      }
    });
  }
  template <class Target>
  void add(const OptionText& name, Target& target, const std::string& about) {
    const auto as_typed = [](const std::string& text, const std::string&) { return text; };
    add(name, target, as_typed, about);
  }
  /// An option whose text goes to `keys`, under its name.
  void add_key(const OptionText& name, TestKeys& keys, const std::string& about) {
    add_row(name, about, false,
            [&keys, key = name.name.substr(2)](const std::string& text) { keys[key] = text; });
  }
  /// `act` is called each time that the flag is given.
  void flag(const OptionText& name, const std::string& about, std::function<void()> act);
  /// A flag that chooses one answer to a question of the tests; another answer's flag refuses it.
  void choice(const std::string& name, const std::string& about, std::function<void()> act);

  /// The line that repeats a test goes there.
  void repeat_by(std::string& line) { replay_line_ = &line; }
  /// Called when all values are read.
  void afterwards(std::function<void()> act) { afterwards_ = std::move(act); }

  void read_values() const;
  CommandText text(const std::string& summary) const;

 private:
  struct Row {
    CLI::Option* option;
    OptionText text;
    std::function<void(const std::string& text)> take;

    Texts given() const;
  };
  void add_row(OptionText text, const std::string& about, bool repeats,
               std::function<void(const std::string&)> take);

  CLI::App& app_;
  std::vector<Row> rows_ = {};
  std::vector<CLI::Option*> choices_ = {};
  std::string* replay_line_ = nullptr;
  std::function<void()> afterwards_ = [] {};
};

/// A command by name. `define` adds its options and returns what makes the command of their values.
struct CommandRow {
  std::string name;
  std::string summary;
  std::function<std::function<Command()>(Options&)> define;
};

std::vector<CommandText> texts_of(const std::vector<CommandRow>& commands);

/// The command that the arguments ask for.
Command parsed(const Texts& arguments, const std::vector<CommandRow>& commands);

// ---- Readers of options' values. Each takes the text and the option's name, and throws an
// InputError that names the option.

/// A whole number, `least` or more.
inline auto at_least(std::uint64_t least) {
  return [least](const std::string& text, const std::string& option) {
    return count_from(Value::scalar(text), option, least);
  };
}

/// The number of a shard, or of all shards, `least` or more.
unsigned read_part(const std::string& text, const std::string& what, std::uint64_t least);

unsigned read_threads(const std::string& text, const std::string& option);
/// A number, as a reader of suites takes it.
template <double (*read)(const Value&, std::string_view)>
double read_number(const std::string& text, const std::string& option) {
  return read(Value::scalar(text), option);
}
inline constexpr auto read_error_rate = read_number<error_rate>;
inline constexpr auto read_positive = read_number<positive_number>;

/// A count, or `random`: 64 bits from the operating system.
std::uint64_t read_seed(const std::string& text, const std::string& option);

/// "I/N" with 1 <= I <= N.
std::pair<unsigned, unsigned> read_shard(const std::string& text, const std::string& option);

/// "KIND=PATH" with a known kind.
ReportRequest read_report(const std::string& text, const std::string& option);

/// One of the words, as the value beside it.
template <class T>
struct OneOf {
  std::vector<std::pair<std::string, T>> meanings;

  std::vector<std::string> words() const {
    return mapped(meanings, &std::pair<std::string, T>::first);
  }
  T operator()(const std::string& text, const std::string& option) const {
    return meanings[choice(Value::scalar(text), option, words())].second;
  }
};

}  // namespace assay::harness
