#include "harness/suite/yaml.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "harness/base/text_file.h"

namespace assay::harness {
namespace {

constexpr std::size_t deepest = 64;

constexpr std::string_view no_aliases =
    "anchors and aliases are not read: put a text that begins with `*` or `&` in quotes, or name a "
    "scene under `scenes:`";

/// Replaces yaml-cpp's messages by what to do.
std::string readable(const std::string& message) {
  static const std::pair<std::string_view, std::string_view> translations[] = {
      {YAML::ErrorMsg::FLOW_END, "a closing bracket that was never opened"},
      {YAML::ErrorMsg::END_OF_MAP_FLOW, "a `{` is not closed, or a comma is missing before this"},
      {YAML::ErrorMsg::END_OF_SEQ_FLOW, "a `[` is not closed, or a comma is missing before this"},
      {YAML::ErrorMsg::END_OF_MAP,
       "expected a key of the map here; is it indented like the other keys, and the line `key: "
       "value`?"},
      {YAML::ErrorMsg::END_OF_SEQ,
       "expected another `- ` item here; indent all items alike, and all keys of an item"},
      {YAML::ErrorMsg::MAP_VALUE,
       "a `:` cannot stand here: a key above may lack its own; indent all keys of a map alike, and "
       "put text that contains `: ` in quotes"},
      {YAML::ErrorMsg::MAP_KEY, "a key cannot stand here"},
      {YAML::ErrorMsg::BLOCK_ENTRY, "a `- ` item cannot stand here"},
      {YAML::ErrorMsg::TAB_IN_INDENTATION, "indent with spaces, not with a tab"},
      {YAML::ErrorMsg::EOF_IN_SCALAR, "a quote is opened and never closed"},
      {YAML::ErrorMsg::DOC_IN_SCALAR, "a quote is opened and never closed"},
      {YAML::ErrorMsg::UNKNOWN_ANCHOR, no_aliases},
      {YAML::ErrorMsg::UNKNOWN_TOKEN, "text cannot begin with this character; put it in quotes"},
  };
  for (const auto& [terse, plain] : translations) {
    if (message.find(terse) != std::string::npos) return std::string(plain);
  }
  return "not YAML: " + message;
}

void refuse_tabs(const std::vector<std::string>& lines, const std::string& file) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t at = lines[i].find_first_not_of(' ');
    const bool tab = at != std::string_view::npos && lines[i][at] == '\t';
    if (tab && lines[i].find_first_not_of(" \t") != std::string_view::npos) {
      refuse({file, static_cast<int>(i) + 1, static_cast<int>(at) + 1},
             "indent with spaces, not with a tab");
    }
  }
}

/// A wrong type and a wrong value get the same message: what is allowed, and what was given.
template <class Read, class Allowed>
auto read_within(const Value& value, std::string_view what, const std::string& range, Read read,
                 Allowed allowed) {
  std::string found = "no single value";
  if (value.kind() == Value::Kind::scalar) {
    found = "`" + value.text() + "`";
    try {
      const auto number = read();
      if (allowed(number)) return number;
    } catch (const InputError&) {
    }
  }
  refuse(value.where(), "{} must be {}, but it is {}", what, range, found);
}

}  // namespace

/// Receives yaml-cpp's events, which still show tags, anchors and repeated keys.
class DocumentBuilder final : public YAML::EventHandler {
 public:
  explicit DocumentBuilder(Document& document) : document_(document) {}

  bool complete() const { return complete_; }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (complete_) refuse(place(mark), "a second document; put each in a file of its own");
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    if (open_.empty()) refuse(place(mark), "there is nothing here");
    Frame& frame = open_.back();
    if (frame.map && !frame.key) refuse(place(mark), "a key is missing before the `:`");
    if (frame.map) refuse_without_value(frame);
    refuse(dash_before(mark), "a list item without a value");
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    refuse(place(mark), std::string(no_aliases));
  }
  void OnAnchor(const YAML::Mark& mark, const std::string&) override { OnAlias(mark, {}); }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                const std::string& text) override {
    refuse_tag(mark, tag);
    const bool plain = tag == "?";
    if (!open_.empty() && open_.back().map && !open_.back().key) return key(mark, text, plain);
    add(Value::scalar(text, plain ? place(mark) : content(mark)));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    open(mark, tag, false);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    open(mark, tag, true);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Frame {
    bool map = false;
    Location where;
    std::vector<Value> items = {};
    std::vector<Value::Member> members = {};
    std::map<std::string, YAML::Mark, std::less<>> seen = {};
    std::optional<std::string> key = {};
    Location key_place = {};
  };

  Location place(const YAML::Mark& mark) const {
    if (document_.only_place_) return *document_.only_place_;
    return {document_.file_, mark.line + 1, mark.column + 1};
  }

  /// yaml-cpp reports a missing item at the next token; the dash is before it, on an earlier line.
  Location dash_before(const YAML::Mark& mark) const {
    for (int number = mark.line; number >= 1; --number) {
      const std::string_view line = document_.line(number);
      const std::size_t last = line.find_last_not_of(' ');
      const std::size_t first = line.find_first_not_of(' ');
      if (last == std::string_view::npos || line[first] == '#') continue;
      if (line[last] != '-') break;
      return {document_.file_, number, static_cast<int>(last) + 1};
    }
    return document_.at_most_last(mark.line + 1, mark.column + 1);
  }

  /// The first character of a quoted or block scalar.
  Location content(const YAML::Mark& mark) const {
    Location where = place(mark);
    const std::string_view line = document_.line(where.line);
    const auto at = static_cast<std::size_t>(mark.column);
    if (at >= line.size() || document_.only_place_) return where;
    if (line[at] == '"' || line[at] == '\'') ++where.column;
    if (line[at] != '|' && line[at] != '>') return where;
    const std::size_t text = document_.line(where.line + 1).find_first_not_of(' ');
    if (text == std::string_view::npos) return where;
    return {where.file, where.line + 1, static_cast<int>(text) + 1};
  }

  void key(const YAML::Mark& mark, const std::string& text, bool plain) {
    Frame& frame = open_.back();
    const Location where = place(mark);
    if (plain && text == "<<") refuse(where, "merge keys `<<` are not read; write the keys out");
    if (text.empty()) refuse(where, "a key is missing before the `:`");
    const auto [first, unseen] = frame.seen.emplace(text, mark);
    if (!unseen) {
      refuse(where, "duplicate key `{}`; it is already given at {}:{}", text,
             first->second.line + 1, first->second.column + 1);
    }
    frame.key = text;
    frame.key_place = where;
  }

  void open(const YAML::Mark& mark, const std::string& tag, bool map) {
    refuse_tag(mark, tag);
    if (!open_.empty() && open_.back().map && !open_.back().key) {
      refuse(place(mark), "a key must be text, not a list or a map");
    }
    if (open_.size() == deepest) refuse(place(mark), "nested deeper than 64 levels");
    open_.push_back({.map = map, .where = place(mark)});
  }

  void close() {
    Frame frame = std::move(open_.back());
    open_.pop_back();
    add(frame.map ? Value::map(std::move(frame.members), frame.where)
                  : Value::list(std::move(frame.items), frame.where));
  }

  void add(Value value) {
    if (open_.empty()) {
      document_.root_ = std::move(value);
      complete_ = true;
      return;
    }
    Frame& frame = open_.back();
    if (!frame.map) return frame.items.push_back(std::move(value));
    document_.keys_[{value.where().line, value.where().column}] = frame.key_place;
    frame.members.emplace_back(std::move(*frame.key), std::move(value));
    frame.key.reset();
  }

  /// YAML reads `{claim: quantile(a, 0.5) == 1}` as a claim that ends at the comma, and another
  /// key. Unbalanced brackets reveal it.
  [[noreturn]] void refuse_without_value(const Frame& frame) const {
    const auto open_brackets = [](const std::string& text) {
      return std::ranges::count(text, '(') - std::ranges::count(text, ')');
    };
    const Value::Member* before = frame.members.empty() ? nullptr : &frame.members.back();
    const bool cut = before && before->second.kind() == Value::Kind::scalar &&
                     open_brackets(before->second.text()) > 0 && open_brackets(*frame.key) < 0;
    const bool joined = frame.key->find(':') != std::string::npos;
    if (!cut)
      refuse(frame.key_place, "`{}` has no value{}", *frame.key,
             joined ? "; put a blank after its colon" : "");
    refuse(frame.key_place,
           "inside {{…}} a comma ends the value of `{0}`; quote the {0}: `{0}: \"{1}, {2}\"`",
           before->first, before->second.text(), *frame.key);
  }

  void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (tag.empty() || tag == "?" || tag == "!") return;
    refuse(place(mark), "the tag `{}` is not read; leave it out", tag);
  }

  Document& document_;
  std::vector<Frame> open_;
  bool complete_ = false;
};

Document::Document(std::string file, std::string_view text, std::optional<Location> only_place)
    : file_(std::move(file)), only_place_(std::move(only_place)) {
  require_utf8(text, file_);
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  for (const std::string_view line : lines_of(text)) lines_.emplace_back(line);
  refuse_tabs(lines_, file_);
  // yaml-cpp takes the end of a text right after a line end for a closing quote; a comment prevents
  // it.
  std::istringstream in(std::string(text) + "\n#");
  DocumentBuilder builder(*this);
  try {
    YAML::Parser parser(in);
    while (parser.HandleNextDocument(builder)) continue;
  } catch (const YAML::Exception& e) {
    const std::string_view above = line(e.mark.line);
    const auto first = above.find_first_not_of(' ');
    const bool is_key = first != above.npos && above.find(':') == above.npos &&
                        above[first] != '#' && above[first] != '-';
    const bool at_its_key =
        line(e.mark.line + 1).find(':') == static_cast<std::size_t>(e.mark.column);
    if (e.msg == YAML::ErrorMsg::MAP_VALUE && is_key && at_its_key)
      refuse({file_, e.mark.line, 1}, "this line may lack a `:` after its key");
    refuse(at_most_last(e.mark.line + 1, e.mark.column + 1), readable(e.msg));
  }
  if (!builder.complete()) refuse({file_, 1, 1}, "the file is empty");
}

Location Document::at_most_last(int line, int column) const {
  const int last = std::max(static_cast<int>(lines_.size()), 1);
  if (line <= last) return {file_, line, column};
  return {file_, last, static_cast<int>(this->line(last).size()) + 1};
}

Location Document::key(const Value& member) const {
  const auto found = keys_.find({member.where().line, member.where().column});
  return found == keys_.end() ? member.where() : found->second;
}

std::string_view Document::line(int number) const {
  const auto index = static_cast<std::size_t>(number) - 1;
  return number < 1 || index >= lines_.size() ? std::string_view{} : lines_[index];
}

Value read_flow(std::string_view text, const Location& where) {
  if (text.find('\n') != std::string_view::npos) refuse(where, "a value is one line");
  if (text.find_first_not_of(' ') == std::string_view::npos) {
    refuse(where, "a value is missing after the `=`");
  }
  // Standard input, not a list.
  if (text == "-") return Value::scalar("-", where);
  try {
    return Document("", text, where).root();
  } catch (const InputError& e) {
    refuse(where, "`{}`: {}", text, e.message());
  }
}

std::vector<std::string> split_outside_brackets(std::string_view text) {
  std::vector<std::string> pieces(1);
  int depth = 0;
  char quote = 0;
  bool escaped = false;
  for (const char c : text) {
    if (quote) {
      if (c == quote && !escaped) quote = 0;
      escaped = quote == '"' && c == '\\' && !escaped;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    } else if (c == ',' && depth <= 0) {
      pieces.emplace_back();
      continue;
    }
    pieces.back() += c;
  }
  return pieces;
}

std::string suggestion(std::string_view name, const std::vector<std::string>& candidates) {
  return did_you_mean(name, candidates,
                      candidates.empty() ? "there is none" : "there is: " + listed(candidates));
}

Keys::Keys(const Document& document, const Value& map, std::string what, std::string_view example,
           const std::vector<std::string>& known)
    : map_(map), what_(std::move(what)) {
  if (map.kind() != Value::Kind::map) {
    refuse(map.where(), "{} must be a map of keys and values, as in `{}`", what_, example);
  }
  for (const auto& [key, value] : map.members()) {
    if (std::ranges::find(known, key) == known.end()) {
      refuse(document.key(value), "unknown key `{}` of {}{}", key, what_, suggestion(key, known));
    }
  }
}

const Value& Keys::require(std::string_view key, std::string_view example) const {
  if (const Value* value = find(key)) return *value;
  refuse(map_.where(), "{} needs the key `{}`, as in `{}`", what_, key, example);
}

double positive_number(const Value& value, std::string_view what) {
  return read_within(
      value, what, "a number above 0", [&] { return value.number(what); },
      [](double number) { return number > 0 && std::isfinite(number); });
}

bool is_error_rate(double rate) { return rate >= 1e-9 && rate <= 0.5; }

double error_rate(const Value& value, std::string_view what) {
  return read_within(
      value, what, "a number from 1e-9 to 0.5 (5 % is 0.05)", [&] { return value.number(what); },
      is_error_rate);
}

std::uint64_t count_from(const Value& value, std::string_view what, std::uint64_t least) {
  return read_within(
      value, what, fmt::format("a whole number, {} or more", least),
      [&] { return value.count(what); }, [&](std::uint64_t count) { return count >= least; });
}

std::string one_line(const Value& value, std::string_view what) {
  const std::string& text = value.string(what);
  const bool blank = text.find_first_not_of(" \t\n") == std::string::npos;
  if (!blank && text.find('\n') == std::string::npos) return text;
  refuse(value.where(), "{} must be one line of text", what);
}

std::size_t choice(const Value& value, std::string_view what,
                   const std::vector<std::string>& allowed) {
  const std::string& text = value.string(what);
  const auto found = std::ranges::find(allowed, text);
  if (found != allowed.end()) return static_cast<std::size_t>(found - allowed.begin());
  refuse(value.where(), "{} cannot be `{}`{}", what, text, suggestion(text, allowed));
}

}  // namespace assay::harness
