#include "reports/formats/read_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "reports/formats/base64.h"
#include "reports/formats/json.h"
#include "reports/words/display.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void fail(const std::string& place, const std::string& sentence) {
  throw ReadError(place.empty() ? sentence : place + ": " + sentence);
}

[[noreturn]] void wrong_type(const std::string& place, const char* wanted, const Json& node) {
  // Only a scalar is shown: printing recurses, and nesting may be as deep as the file is long.
  std::string found = node.type_name();
  if (node.is_primitive()) found = node.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (found.size() > 60) found = "a long " + std::string(node.type_name());
  fail(place, fmt::format("should be {}, but is {}", wanted, found));
}

template <class T>
void read(const Json& node, const std::string& place, T& value);

bool special_number(const Json& node, double& value) {
  if (!node.is_string()) return false;
  const auto& text = node.get_ref<const std::string&>();
  using Limits = std::numeric_limits<double>;
  if (text == "NaN") value = Limits::quiet_NaN();
  if (text == "Infinity") value = Limits::infinity();
  if (text == "-Infinity") value = -Limits::infinity();
  return text == "NaN" || text == "Infinity" || text == "-Infinity";
}

void leaf(const Json& node, const std::string& place, double& value) {
  if (special_number(node, value)) return;
  if (!node.is_number()) wrong_type(place, "a number", node);
  value = node.get<double>();
}

void leaf(const Json& node, const std::string& place, Number& value) {
  value.reset();
  if (node.is_null()) return;
  double number = 0;
  if (!node.is_number() && !special_number(node, number))
    wrong_type(place, "a number or null", node);
  leaf(node, place, number);
  value = number;
}

void leaf(const Json& node, const std::string& place, std::string& value) {
  if (!node.is_string()) wrong_type(place, "text", node);
  value = clean(node.get<std::string>());  // as it would be written
}

void leaf(const Json& node, const std::string& place, Texels& value) {
  if (!node.is_string()) wrong_type(place, "base64 of 32-bit floats", node);
  const auto bytes = from_base64(node.get_ref<const std::string&>());
  if (!bytes || bytes->size() % sizeof(float) != 0) {
    fail(place, "should be base64 of 32-bit floats");
  }
  value.values = floats_of(*bytes);
}

template <class T>
void leaf(const Json& node, const std::string& place, std::optional<T>& value) {
  value.reset();
  if (node.is_null()) return;
  T held{};
  read(node, place, held);
  value = std::move(held);
}

void leaf(const Json& node, const std::string& place, bool& value) {
  if (!node.is_boolean()) wrong_type(place, "true or false", node);
  value = node.get<bool>();
}

void leaf(const Json& node, const std::string& place, std::uint64_t& value) {
  if (!node.is_number_unsigned()) wrong_type(place, "a whole number from 0", node);
  value = node.get<std::uint64_t>();
}

void leaf(const Json& node, const std::string& place, int& value) {
  if (!node.is_number_integer() || node.get<double>() > std::numeric_limits<int>::max() ||
      node.get<double>() < std::numeric_limits<int>::min())
    wrong_type(place, "a whole number", node);
  value = node.get<int>();
}

void leaf(const Json& node, const std::string& place, Verdict& value) {
  const auto* const name =
      std::ranges::find_if(verdict_names, [&](auto each) { return node == each; });
  if (name == std::end(verdict_names))
    wrong_type(place, "pass, fail, inconclusive, invalid, error or skipped", node);
  value = static_cast<Verdict>(name - verdict_names);
}

template <class T>
void leaf(const Json& node, const std::string& place, std::vector<T>& values) {
  if (!node.is_array()) wrong_type(place, "an array", node);
  values.clear();
  values.reserve(node.size());
  for (const Json& item : node) {
    T value{};
    read(item, fmt::format("{}[{}]", place, values.size()), value);
    values.push_back(std::move(value));
  }
}

/// True for a key that follows from others: it is written for readers, never read.
template <class T>
bool is_derived(std::string_view key) {
  if constexpr (std::same_as<T, Test>) {
    if (std::ranges::find(keys_of_worst_channel, key) != keys_of_worst_channel.end()) return true;
  }
  if constexpr (std::same_as<T, Suite>) {
    if (key == "answers") return true;
  }
  return key == "display" && requires(const T& value) { display(value); };
}

const Json& member(const Json& object, const std::string& place, const std::string& key) {
  const auto found = object.find(key);
  if (found == object.end()) fail(place, fmt::format("the key \"{}\" is missing", key));
  return *found;
}

template <class T>
void read(const Json& node, const std::string& place, T& value) {
  if constexpr (has_fields<T>) {
    if (!node.is_object()) wrong_type(place, "an object", node);
    std::set<std::string_view> known;
    for_each_field(value, [&](std::string_view name, auto& field) {
      const std::string key(name);
      read(member(node, place, key), place.empty() ? key : place + "." + key, field);
      known.insert(name);
    });
    for (const auto& item : node.items()) {
      if (!known.contains(item.key()) && !is_derived<T>(item.key()))
        fail(place, fmt::format("the key \"{}\" is unknown", item.key()));
    }
  } else {
    leaf(node, place, value);
  }
}

// Refuses a key that stands twice in an object: a parser would silently take the last.
class RepeatedKeys {
 public:
  bool operator()(int, Json::parse_event_t event, Json& value) {
    if (event == Json::parse_event_t::object_start) open_.emplace_back();
    if (event == Json::parse_event_t::object_end) open_.pop_back();
    if (event == Json::parse_event_t::key) {
      const auto key = value.get<std::string>();
      if (!open_.back().insert(key).second)
        fail("", fmt::format("the key \"{}\" stands twice in one object", key));
    }
    return true;
  }

 private:
  std::vector<std::set<std::string>> open_;
};

std::string place_in(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte > 0 ? byte - 1 : 0);
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const std::size_t start = before.rfind('\n');
  const std::size_t column = before.size() - (start == std::string_view::npos ? 0 : start + 1) + 1;
  return fmt::format("line {}, column {}", line, column);
}

Json parse(std::string_view text) {
  RepeatedKeys repeated;
  try {
    return Json::parse(text.begin(), text.end(), std::ref(repeated));
  } catch (const Json::parse_error& error) {
    if (error.byte >= text.size()) fail("", "not a whole JSON text: it ends too early");
    fail("", fmt::format("not JSON: syntax error at {}", place_in(text, error.byte)));
  } catch (const Json::out_of_range&) {
    fail("", "not readable: a number is out of a double's range");
  }
}

/// Adds the keys that earlier versions had not.
void upgrade(Json& root) {
  const auto each = [](Json& node, const char* key, const auto& visit) {
    if (!node.is_object() || !node.contains(key) || !node[key].is_array()) return;
    for (Json& child : node[key]) visit(child);
  };
  const auto add_effect = [](Json& node) {
    if (node.is_object()) node.emplace("effect", nullptr);
  };
  each(root, "suites", [&](Json& suite) {
    each(suite, "tests", [&](Json& test) {
      each(test, "looks", add_effect);
      if (test.is_object()) test.emplace("paired", false);
      if (!test.is_object() || !test.contains("image") || !test["image"].is_object()) return;
      each(test["image"], "groups", add_effect);
      if (test["image"].contains("winner")) add_effect(test["image"]["winner"]);
    });
  });
  root["schema"] = schema_version;
}

void check_version(const Json& root) {
  if (!root.is_object() || !root.contains("schema"))
    fail("", "not a record of assay: the key \"schema\" is missing");
  const Json& version = root["schema"];
  if (version != 1 && version != 2 && version != schema_version)
    fail("schema",
         fmt::format("written with version {} of the record, this program reads 1 to {}",
                     version.is_number() ? version.dump() : version.type_name(), schema_version));
}

/// A map has a number for each element.
void check_maps(const Record& record) {
  for (const Suite& suite : record.suites) {
    for (const Test& test : suite.tests) {
      for (const Map& map : test.maps) {
        const std::size_t wanted = map.width * map.height * map.components.size();
        if (map.texels.values.size() == wanted) continue;
        fail("maps", fmt::format("{} of \"{}\" should have {} numbers, but has {}", map.name,
                                 test.id, wanted, map.texels.values.size()));
      }
    }
  }
}

}  // namespace

Record read_json(std::string_view text, std::string_view file_name) {
  try {
    Json root = parse(text);
    check_version(root);
    if (root["schema"] != schema_version) upgrade(root);
    Record record;
    read(root, "", record);
    check_maps(record);
    return record;
  } catch (const ReadError& error) {
    throw ReadError(fmt::format("{}: {}", file_name, error.what()));
  }
}

}  // namespace assay::reports
