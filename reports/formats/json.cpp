#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <nlohmann/json.hpp>
#include <ranges>
#include <set>
#include <string>
#include <utility>

#include "reports/formats/base64.h"
#include "reports/record/calibration.h"
#include "reports/report_formats.h"
#include "reports/words/describe.h"
#include "reports/words/display.h"
#include "reports/words/number.h"
#include "reports/words/statements.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json tree(const T& value);

Json leaf(double value) {
  if (std::isfinite(value)) return value;
  return round_trip(value);
}
Json leaf(const std::string& value) { return clean(value); }
Json leaf(const Texels& value) { return base64(bytes_of(value.values)); }
Json leaf(Verdict value) { return to_string(value); }
Json leaf(std::integral auto value) { return value; }

template <class T>
Json leaf(const std::optional<T>& value) {
  return value ? tree(*value) : Json(nullptr);
}

template <class T>
Json leaf(const std::vector<T>& values) {
  Json array = Json::array();
  for (const T& value : values) array.push_back(tree(value));
  return array;
}

/// Adds what follows from a value: sentences, answers, and the numbers of a test's worst channel.
/// Readers want them in their place; nothing reads them back.
template <class T>
void derive(const T& value, Json& object) {
  if constexpr (std::same_as<T, Suite>) object["answers"] = tree(answers(value));
  if constexpr (std::same_as<T, Test>) {
    Json worst = tree(worst_channel(value));
    for (const char* key : {"name", "reference", "laws"}) worst.erase(key);
    object.update(worst);
  }
  if constexpr (requires { display(value); }) object["display"] = tree(display(value));
}

template <class T>
Json tree(const T& value) {
  if constexpr (has_fields<T>) {
    Json object = Json::object();
    for_each_field(value, [&](std::string_view key, const auto& member) {
      object[std::string(key)] = tree(member);
    });
    derive(value, object);
    return object;
  } else {
    return leaf(value);
  }
}

constexpr std::size_t longest_line = 240;

// A histogram is one line, and so is a small object: an effect, a cost, a point.
bool one_line_node(const Json& node) {
  if (!node.is_structured() || node.empty()) return true;
  const bool flat =
      std::ranges::none_of(node, [](const Json& child) { return child.is_structured(); });
  return flat && (node.is_array() || node.dump().size() <= longest_line);
}

void print(const Json& node, const std::string& indent, std::string& out) {
  if (one_line_node(node)) {
    out += node.dump();
    return;
  }
  const std::string inner = indent + "  ";
  out += node.is_array() ? '[' : '{';
  const char* separator = "\n";
  for (const auto& item : node.items()) {
    out += separator + inner;
    if (node.is_object()) out += Json(item.key()).dump() + ": ";
    print(item.value(), inner, out);
    separator = ",\n";
  }
  out += "\n" + indent + (node.is_array() ? ']' : '}');
}

std::string printed(const Json& root) {
  std::string out;
  print(root, "", out);
  return out + "\n";
}

/// True for a key that follows from others: it is written for readers, never read.
template <class T>
bool is_derived(std::string_view key) {
  static const Json derived = [] {
    Json object = Json::object();
    derive(T{}, object);
    return object;
  }();
  return derived.contains(key);
}

/// True for a key that records of earlier versions need not have.
template <class T>
bool is_new(std::string_view key) {
  if constexpr (std::same_as<T, Look>) return key == "effect";
  if constexpr (std::same_as<T, ImageFinding>) return key == "effect" || key == "others";
  if constexpr (std::same_as<T, Test>) {
    return key == "paired" || key == "advice" || key == "no_replay";
  }
  if constexpr (std::same_as<T, LedgerNight>) return key == "mean";
  return false;
}

/// Reads values, and knows the place of the one that it reads.
class Reader {
 public:
  void read_record(const Json& root, Record& record) {
    if (!root.is_object() || !root.contains("schema"))
      fail("not a record of assay: the key \"schema\" is missing");
    const Json& version = root["schema"];
    const auto is = [&](int known) { return version == known; };
    if (std::ranges::none_of(std::views::iota(1, schema_version + 1), is))
      fail(fmt::format("schema: written with version {} of the record, this program reads 1 to {}",
                       version.is_number() ? version.dump() : version.type_name(), schema_version));
    is_old_ = !is(schema_version);
    read(root, record);
    record.schema = schema_version;
  }

 private:
  [[noreturn]] void fail(const std::string& sentence) const {
    throw ReadError(place_.empty() ? sentence : place_ + ": " + sentence);
  }

  void require(bool fits, const char* wanted, const Json& node) const {
    if (fits) return;
    // Only a scalar is shown: printing recurses, and nesting may be as deep as the file is long.
    std::string found = node.type_name();
    if (node.is_primitive()) found = node.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (found.size() > 60) found = "a long " + std::string(node.type_name());
    fail(fmt::format("should be {}, but is {}", wanted, found));
  }

  /// Reads a value at a place inside this one.
  template <class T>
  void read_at(const std::string& place, const Json& node, T& value) {
    const std::size_t length = place_.size();
    place_ += place;
    read(node, value);
    place_.resize(length);
  }

  template <has_fields T>
  void read(const Json& node, T& value) {
    require(node.is_object(), "an object", node);
    std::set<std::string_view> known;
    for_each_field(value, [&](std::string_view name, auto& field) {
      const std::string key(name);
      known.insert(name);
      if (const auto found = node.find(key); found != node.end()) {
        read_at(place_.empty() ? key : "." + key, *found, field);
      } else if (!is_old_ || !is_new<T>(name)) {
        fail(fmt::format("the key \"{}\" is missing", key));
      }
    });
    for (const auto& item : node.items()) {
      // An older record may have keys that are gone.
      if (!is_old_ && !known.contains(item.key()) && !is_derived<T>(item.key()))
        fail(fmt::format("the key \"{}\" is unknown", item.key()));
    }
  }

  template <class T>
  void read(const Json& node, std::vector<T>& values) {
    require(node.is_array(), "an array", node);
    values.clear();
    values.reserve(node.size());
    for (const Json& item : node) {
      T value{};
      read_at(fmt::format("[{}]", values.size()), item, value);
      values.push_back(std::move(value));
    }
  }

  template <class T>
  void read(const Json& node, std::optional<T>& value) {
    value.reset();
    if (!node.is_null()) read(node, value.emplace());
  }

  void read(const Json& node, double& value) {
    using Limits = std::numeric_limits<double>;
    for (const double special : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
      value = special;
      if (node == round_trip(special)) return;
    }
    require(node.is_number(), "a number", node);
    value = node.get<double>();
  }

  void read(const Json& node, std::string& value) {
    require(node.is_string(), "text", node);
    value = clean(node.get<std::string>());  // as it would be written
  }

  void read(const Json& node, Texels& value) {
    constexpr const char* wanted = "base64 of 32-bit floats";
    require(node.is_string(), wanted, node);
    const auto bytes = from_base64(node.get_ref<const std::string&>());
    if (!bytes || bytes->size() % sizeof(float) != 0) fail(fmt::format("should be {}", wanted));
    value.values = floats_of(*bytes);
  }

  void read(const Json& node, bool& value) {
    require(node.is_boolean(), "true or false", node);
    value = node.get<bool>();
  }

  void read(const Json& node, std::uint64_t& value) {
    require(node.is_number_unsigned(), "a whole number from 0", node);
    value = node.get<std::uint64_t>();
  }

  void read(const Json& node, int& value) {
    using Limits = std::numeric_limits<int>;
    require(node.is_number_integer() && node.get<double>() <= Limits::max() &&
                node.get<double>() >= Limits::min(),
            "a whole number", node);
    value = node.get<int>();
  }

  void read(const Json& node, Verdict& value) {
    const auto* const name =
        std::ranges::find_if(verdict_names, [&](auto each) { return node == each; });
    require(name != std::end(verdict_names), "pass, fail, inconclusive, invalid, error or skipped",
            node);
    value = static_cast<Verdict>(name - verdict_names);
  }

  std::string place_;
  bool is_old_ = false;
};

std::string place_in(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte > 0 ? byte - 1 : 0);
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const std::size_t start = before.rfind('\n');
  const std::size_t column = before.size() - (start == std::string_view::npos ? 0 : start + 1) + 1;
  return fmt::format("line {}, column {}", line, column);
}

Json parse(std::string_view text) {
  std::vector<std::set<std::string>> open;  // keys of the objects around a place
  // A parser would silently take the last of two equal keys.
  const auto refuse_repeated = [&](int, Json::parse_event_t event, const Json& value) {
    if (event == Json::parse_event_t::object_start) open.emplace_back();
    if (event == Json::parse_event_t::object_end) open.pop_back();
    if (event == Json::parse_event_t::key && !open.back().insert(value.get<std::string>()).second)
      throw ReadError(
          fmt::format("the key \"{}\" stands twice in one object", value.get<std::string>()));
    return true;
  };
  try {
    return Json::parse(text.begin(), text.end(), refuse_repeated);
  } catch (const Json::parse_error& error) {
    if (error.byte >= text.size()) throw ReadError("not a whole JSON text: it ends too early");
    throw ReadError(fmt::format("not JSON: syntax error at {}", place_in(text, error.byte)));
  } catch (const Json::out_of_range&) {
    throw ReadError("not readable: a number is out of a double's range");
  }
}

/// A map has a number for each element.
void check_maps(const Record& record) {
  for (const Test* test : tests_of(record)) {
    for (const Map& map : test->maps) {
      const std::size_t wanted = map.width * map.height * map.components.size();
      if (map.texels.values.size() == wanted) continue;
      throw ReadError(fmt::format("maps: {} of \"{}\" should have {} numbers, but has {}", map.name,
                                  test->id, wanted, map.texels.values.size()));
    }
  }
}

}  // namespace

std::string json(const Record& record) { return printed(tree(record)); }

std::string compact_json(const Record& record) { return tree(record).dump(); }

std::string json(const Calibration& calibration) { return printed(tree(calibration)); }

Record read_json(std::string_view text, std::string_view file_name) {
  try {
    Record record;
    Reader().read_record(parse(text), record);
    check_maps(record);
    return record;
  } catch (const ReadError& error) {
    throw ReadError(fmt::format("{}: {}", file_name, error.what()));
  }
}

}  // namespace assay::reports
