#include "estimators/core/flow.h"

#include <yaml-cpp/yaml.h>

#include <stdexcept>

namespace assay {

namespace {

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

}  // namespace assay
