#include "estimators/core/value.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <boost/algorithm/string.hpp>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <map>
#include <sstream>

#include "estimators/core/mapped.h"

namespace assay {

namespace {

std::string quoted(const std::string& text) {
  std::ostringstream out;
  out << std::quoted(text);
  // Within quotes YAML would fold the end of a line to a blank.
  return boost::replace_all_copy(out.str(), "\n", "\\n");
}

[[noreturn]] void wrong_type(const Value& value, std::string_view what, const char* wanted) {
  constexpr const char* kinds[] = {"nothing", "text", "a list", "a map"};
  const std::string found = value.kind() == Value::Kind::scalar
                                ? "`" + value.text() + "`"
                                : kinds[static_cast<int>(value.kind())];
  throw InputError(value.where(),
                   std::string(what) + " must be " + wanted + ", but it is " + found);
}

std::string canonical_scalar(const std::string& text) {
  const std::optional<double> number = parse_number(text);
  return number && std::isfinite(*number) ? shortest_text(*number) : quoted(text);
}

std::string canonical_map(const std::vector<Value::Member>& members) {
  std::map<std::string, std::string> sorted;
  for (const auto& [key, value] : members) sorted[key] = quoted(key) + ":" + value.canonical();
  return "{" + listed(mapped(sorted, &std::pair<const std::string, std::string>::second), ",") +
         "}";
}

// Optimal string alignment distance: insertions, deletions, substitutions, swaps of neighbours.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, substituted});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

Value value_of(const YAML::Node& node, std::string_view source) {
  constexpr std::string_view null = "null";
  const auto place = static_cast<std::size_t>(node.Mark().pos);
  if (node.IsNull() && source.substr(place).starts_with(null)) return {};
  if (node.IsScalar()) return Value::scalar(node.Scalar());
  if (node.IsSequence()) {
    std::vector<Value> items;
    for (const YAML::Node& item : node) items.push_back(value_of(item, source));
    return Value::list(std::move(items));
  }
  if (!node.IsMap()) throw YAML::Exception(node.Mark(), "a value is missing");
  std::vector<Value::Member> members;
  for (const auto& each : node) {
    members.emplace_back(each.first.Scalar(), value_of(each.second, source));
  }
  return Value::map(std::move(members));
}

}  // namespace

std::string to_string(const Location& where) {
  if (where.line == 0) return where.file;
  return where.file + ":" + std::to_string(where.line) + ":" + std::to_string(where.column);
}

InputError::InputError(Location where, const std::string& what, std::optional<std::string> line)
    : std::runtime_error(to_string(where).empty() ? what : to_string(where) + ": " + what),
      where_(std::move(where)),
      message_(what),
      line_(std::move(line)) {}

void InputError::add(const InputError& other) {
  const auto same = [&](const InputError& each) {
    return each.what() == std::string(other.what());
  };
  if (!same(*this) && std::ranges::none_of(others_, same))
    others_.emplace_back(other.where_, other.message_, other.line_);
  for (const InputError& each : other.others_) add(each);
}

Value::Value(const Value&) = default;
Value::Value(Value&&) noexcept = default;
Value& Value::operator=(const Value&) = default;
Value& Value::operator=(Value&&) noexcept = default;
Value::~Value() = default;

Value Value::scalar(std::string text, Location where) {
  Value value;
  value.kind_ = Kind::scalar;
  value.text_ = std::move(text);
  value.where_ = std::move(where);
  return value;
}

Value Value::list(std::vector<Value> items, Location where) {
  Value value;
  value.kind_ = Kind::list;
  value.items_ = std::move(items);
  value.where_ = std::move(where);
  return value;
}

Value Value::map(std::vector<Member> members, Location where) {
  Value value;
  value.kind_ = Kind::map;
  value.members_ = std::move(members);
  value.where_ = std::move(where);
  return value;
}

const Value* Value::find(std::string_view key) const {
  const auto member = std::ranges::find(members_, key, &Member::first);
  return member == members_.end() ? nullptr : &member->second;
}

void Value::require(bool holds, const std::string& why) const {
  if (!holds) throw InputError(where_, why);
}

double Value::number(std::string_view what) const {
  if (kind_ != Kind::scalar) wrong_type(*this, what, "a number");
  const std::optional<double> value = parse_number(text_);
  if (!value) wrong_type(*this, what, "a number");
  return *value;
}

std::uint64_t Value::count(std::string_view what) const {
  constexpr const char* wanted = "a whole number, 0 or more";
  if (kind_ != Kind::scalar) wrong_type(*this, what, wanted);
  if (const auto digits = read_as<std::uint64_t>(text_)) return *digits;
  const std::optional<double> value = parse_number(text_);
  // Up to 2^53 every whole double stands for itself; above, 1e17 might not be what was meant.
  const bool exact = value && *value >= 0 && *value <= 0x1p53 && *value == std::floor(*value);
  if (!exact) wrong_type(*this, what, wanted);
  return static_cast<std::uint64_t>(*value);
}

bool Value::boolean(std::string_view what) const {
  if (kind_ == Kind::scalar && text_ == "true") return true;
  if (kind_ == Kind::scalar && text_ == "false") return false;
  wrong_type(*this, what, "true or false");
}

const std::string& Value::string(std::string_view what) const {
  if (kind_ != Kind::scalar) wrong_type(*this, what, "text");
  return text_;
}

std::string Value::canonical() const {
  switch (kind_) {
    case Kind::null:
      return "null";
    case Kind::scalar:
      return canonical_scalar(text_);
    case Kind::list:
      return "[" + listed(mapped(items_, &Value::canonical), ",") + "]";
    case Kind::map:
      return canonical_map(members_);
  }
  return "";
}

Value parse_flow(std::string_view text) {
  // A word behind the text shows that the text is one value.
  const std::string source = "[" + std::string(text) + "\n, end]";
  try {
    const YAML::Node list = YAML::Load(source);
    if (list.size() == 2 && list[1].Scalar() == "end") return value_of(list[0], source);
  } catch (const YAML::Exception&) {
  }
  throw std::logic_error("the fallback `" + std::string(text) + "` is no YAML of one line");
}

std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with("+-")) return {};
  if (text.starts_with('+')) text.remove_prefix(1);
  return read_as<double>(text);
}

std::string_view take_word(std::string_view& line) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t begin = line.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return line = {};
  const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

bool matches(std::string_view pattern, std::string_view text) {
  std::size_t p = 0;
  std::size_t t = 0;
  std::size_t star = std::string_view::npos;  // the last one, and where the text went on after it
  std::size_t after = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      after = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++after;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

std::string shortest_text(double value) {
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end};
}

std::string nearest(std::string_view name, const std::vector<std::string>& candidates) {
  // A word that was cut short, or lacks its family: the shortest candidate that begins or ends so.
  // An option's dashes tell nothing.
  constexpr std::size_t least_beginning = 3;
  const std::size_t letters = name.size() - std::min(name.find_first_not_of('-'), name.size());
  std::vector<std::string> begun;
  for (const std::string& candidate : candidates) {
    const bool cut = candidate.starts_with(name) || candidate.ends_with("/" + std::string(name));
    if (letters >= least_beginning && cut) begun.push_back(candidate);
  }
  if (!begun.empty()) return *std::ranges::min_element(begun, {}, &std::string::size);
  // One slip for every three letters, at least one: `sceen` suggests `scene`, `x` suggests nothing.
  std::size_t best = std::min(std::max<std::size_t>(1, name.size() / 3) + 1, name.size());
  std::string found;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < best) {
      best = distance;
      found = candidate;
    }
  }
  return found;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates,
                         std::string_view otherwise) {
  const std::string near = nearest(name, candidates);
  if (!near.empty()) return "; did you mean `" + near + "`?";
  return otherwise.empty() ? "" : "; " + std::string(otherwise);
}

std::string near_file(const std::string& file, std::string_view otherwise) {
  const std::filesystem::path path(file);
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& each : std::filesystem::directory_iterator(path.parent_path() / ".", ignored)) {
    if (each.is_regular_file(ignored)) names.push_back(each.path().filename());
  }
  const std::string near = nearest(path.filename().string(), names);
  if (near.empty()) return did_you_mean(file, {}, otherwise);
  return "; did you mean `" + (path.parent_path() / near).string() + "`?";
}

std::string listed(const std::vector<std::string>& names, std::string_view separator) {
  return boost::join(names, separator);
}

std::vector<std::string> pieces_of(std::string_view text, char separator) {
  std::vector<std::string> pieces;
  boost::split(pieces, text, [separator](char c) { return c == separator; });
  for (std::string& piece : pieces) boost::trim_if(piece, [](char c) { return c == ' '; });
  return pieces;
}

std::string quoted(const std::vector<std::string>& names) {
  // A file may have thousands of columns.
  constexpr std::size_t most = 16;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) {
    text += (i == 0 ? "`" : ", `") + names[i] + "`";
  }
  if (names.size() > most) text += ", … (" + std::to_string(names.size()) + " in all)";
  return text;
}

double finite_number(const Value& value, const std::string& what) {
  const double number = value.number(what);
  value.require(std::isfinite(number), what + " must be finite");
  return number;
}

double at_least_zero(const Value& value, const std::string& what) {
  const double number = finite_number(value, what);
  value.require(number >= 0, what + " must not be negative");
  return number;
}

double above_zero(const Value& value, const std::string& what) {
  const double number = finite_number(value, what);
  value.require(number > 0, what + " must be above 0");
  return number;
}

std::string alternatives(std::string_view name, const std::vector<std::string>& known) {
  return did_you_mean(name, known, "known are " + quoted(known));
}

void require_keys(const Value& value, const std::string& what,
                  const std::vector<std::string>& known) {
  value.require(value.kind() == Value::Kind::map, what + " must be a map");
  for (const auto& [key, member] : value.members()) {
    if (std::ranges::find(known, key) == known.end()) {
      throw InputError(member.where(),
                       what + " has no key `" + key + "`" + alternatives(key, known));
    }
  }
}

const Value& required_key(const Value& value, const std::string& what, const char* key) {
  if (const Value* found = value.find(key)) return *found;
  throw InputError(value.where(), what + " needs the key `" + key + "`");
}

Value scene_of(const Value& value, std::span<const NamedScene> built_in) {
  if (value.kind() != Value::Kind::scalar) return value;
  const std::string& name = value.string("the scene");
  std::vector<std::string> names;
  for (const NamedScene& scene : built_in) {
    if (name == scene.name) return parse_flow(scene.text);
    names.emplace_back(scene.name);
  }
  throw InputError(value.where(), "there is no scene `" + name + "`" + alternatives(name, names));
}

}  // namespace assay
