#include "reports/formats/json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "reports/formats/base64.h"
#include "reports/record/calibration.h"
#include "reports/record/statements.h"
#include "reports/words/display.h"
#include "reports/words/evidence.h"
#include "reports/words/number.h"
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
Json leaf(const Number& value) { return value ? leaf(*value) : Json(nullptr); }
Json leaf(const std::string& value) { return clean(value); }
Json leaf(const Texels& value) { return base64(bytes_of(value.values)); }
Json leaf(Verdict value) { return to_string(value); }
Json leaf(bool value) { return value; }
Json leaf(int value) { return value; }
Json leaf(std::uint64_t value) { return value; }

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
    for (const std::string_view name : keys_of_worst_channel) {
      const std::string key(name);
      object[key] = std::move(worst[key]);
    }
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

bool flat(const Json& node) {
  for (const Json& child : node) {
    if (child.is_structured()) return false;
  }
  return true;
}

constexpr std::size_t longest_line = 240;

// A histogram is one line, and so is a small object: an effect, a cost, a point.
bool one_line_node(const Json& node) {
  if (!node.is_structured() || node.empty()) return true;
  return flat(node) && (node.is_array() || node.dump().size() <= longest_line);
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

}  // namespace

std::string json(const Record& record) { return printed(tree(record)); }

std::string compact_json(const Record& record) { return tree(record).dump(); }

std::string json(const Calibration& calibration) { return printed(tree(calibration)); }

}  // namespace assay::reports
