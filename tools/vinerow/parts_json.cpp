#include "tools/vinerow/parts_json.h"

#include <cmath>
#include <type_traits>
#include <variant>

namespace vinerow::tools {
namespace {

using PartJson = nlohmann::ordered_json;

const char* word_of(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::kNumber:
      return "number";
    case ParameterKind::kInteger:
      return "integer";
    case ParameterKind::kBoolean:
      return "boolean";
    case ParameterKind::kText:
      return "text";
    case ParameterKind::kPath:
      return "path";
    case ParameterKind::kNumberList:
      return "list of numbers";
    case ParameterKind::kTextList:
      return "list of texts";
    case ParameterKind::kGroup:
      return "mapping";
    case ParameterKind::kGroupList:
      return "list of mappings";
  }
  return "";
}

PartJson parameters_json(const std::vector<ParameterSpec>& specs) {
  PartJson list = PartJson::array();
  for (const ParameterSpec& spec : specs) {
    PartJson json = {{"name", spec.name}, {"kind", word_of(spec.kind)}, {"unit", spec.unit}};
    json["description"] = spec.description;
    json["required"] = spec.required;
    if (!spec.former_name.empty()) json["former_name"] = spec.former_name;
    std::visit(
        [&]<class T>(const T& value) {
          if constexpr (!std::is_same_v<T, std::monostate>) json["default"] = value;
        },
        spec.default_value);
    if (std::isfinite(spec.min)) {
      json["min"] = spec.min;
      json["min_exclusive"] = spec.min_exclusive;
    }
    if (std::isfinite(spec.max)) json["max"] = spec.max;
    if (!spec.choices.empty()) json["choices"] = spec.choices;
    if (spec.size > 0) json["size"] = spec.size;
    if (!spec.fields.empty()) json["fields"] = parameters_json(spec.fields);
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace

nlohmann::ordered_json part_json(const Registry& registry, PartKind kind, const std::string& name) {
  const PartSpec& spec = registry.spec(kind, name);
  PartJson json = {{"kind", to_string(kind)}, {"name", name}, {"version", spec.version}};
  json["origin"] = registry.origin(kind, name);
  json["description"] = spec.description;
  if (spec.default_rate_Hz > 0.0) json["rate_Hz"] = spec.default_rate_Hz;
  json["reads"] = spec.reads;
  json["writes"] = spec.writes;
  for (const ResultSpec& result : spec.results) {
    PartJson one = {{"name", result.name}, {"unit", result.unit}, {"values", result.range.text()}};
    one["title"] = result.title;
    one["definition"] = result.definition;
    one["source"] = result.source;
    json["results"].push_back(std::move(one));
  }
  json["parameters"] = parameters_json(spec.parameters);
  return json;
}

}  // namespace vinerow::tools
