#include "estimators/core/flow.h"

#include <yaml-cpp/yaml.h>

#include <stdexcept>

namespace assay {

namespace {

Value value_of(const YAML::Node& node) {
  if (node.IsScalar()) return Value::scalar(node.Scalar());
  if (node.IsSequence()) {
    std::vector<Value> items;
    for (const YAML::Node& item : node) items.push_back(value_of(item));
    return Value::list(std::move(items));
  }
  if (!node.IsMap()) throw YAML::Exception(node.Mark(), "a value is missing");
  std::vector<Value::Member> members;
  for (const auto& each : node) members.emplace_back(each.first.Scalar(), value_of(each.second));
  return Value::map(std::move(members));
}

}  // namespace

Value parse_flow(std::string_view text) {
  if (text == "null") return {};
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(std::string(text));
    if (documents.size() == 1) return value_of(documents[0]);
  } catch (const YAML::Exception&) {
  }
  throw std::logic_error("the fallback `" + std::string(text) + "` is no YAML of one line");
}

}  // namespace assay
