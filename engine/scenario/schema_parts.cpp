#include "engine/scenario/schema_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/parameter_limits.h"

namespace vinerow::scenario {
namespace {

Json range(Json schema, const ParameterSpec& given) {
  ParameterSpec spec = with_limits_of_unit(given);
  if (given.min_exclusive) {  // "> 0" is clearer than the smallest allowed double
    spec.min = given.min;
    spec.min_exclusive = true;
  }
  const auto bound = [&](double value) -> Json {
    // Whole numbers are printed without point and exponent.
    if (value == std::floor(value) && std::abs(value) < 9e15) {
      return static_cast<std::int64_t>(value);
    }
    // As a double, the largest integer is one more.
    if (spec.kind == ParameterKind::kInteger && value >= 0x1p63) {
      return std::numeric_limits<std::int64_t>::max();
    }
    return value;
  };
  if (std::isfinite(spec.min)) {
    schema[spec.min_exclusive ? "exclusiveMinimum" : "minimum"] = bound(spec.min);
  }
  if (std::isfinite(spec.max)) schema["maximum"] = bound(spec.max);
  return schema;
}

Json choices_of(const ParameterSpec& spec) {
  Json schema = {{"type", "string"}};
  if (!spec.choices.empty()) schema["enum"] = spec.choices;
  return schema;
}

Json include_schema() {
  return any_of({Json{{"type", "string"}, {"minLength", 1}},
                 Json{{"type", "array"}, {"items", {{"type", "string"}, {"minLength", 1}}}}});
}

std::string describe_text(const ParameterSpec& spec) {
  if (spec.unit.empty()) return spec.description;
  return spec.description + (spec.description.empty() ? "[" : " [") + spec.unit + "]";
}

void describe(Json& schema, const ParameterSpec& spec) {
  const std::string text = describe_text(spec);
  if (!text.empty()) schema["description"] = text;
  std::visit(
      [&](const auto& value) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(value)>, std::monostate>) {
          schema["default"] = value;
        }
      },
      spec.default_value);
}

bool is_group(const ParameterSpec& spec) {
  return spec.kind == ParameterKind::kGroup || spec.kind == ParameterKind::kGroupList;
}

/// Schema of a parameter in a partial mapping; `definition` is the complete mapping that describes
/// it.
Json partial_parameter_schema(const ParameterSpec& spec, const std::string& definition) {
  if (is_group(spec)) return parameter_schema(spec, true);
  Json schema = any_of({reference(definition + "/properties/" + spec.name),
                        reference("source_only"), Json{{"type", "null"}}});
  schema["description"] = describe_text(spec);
  return schema;
}

}  // namespace

Json any_of(std::vector<Json> choices) {
  return {{"anyOf", std::move(choices)}};
}

Json or_null(Json schema) {
  return any_of({std::move(schema), Json{{"type", "null"}}});
}

Json reference(const std::string& name) {
  return {{"$ref", "#/$defs/" + name}};
}

Json object_of(Json properties, const std::vector<std::string>& required_keys, bool partial) {
  properties["include"] = reference("include");
  Json schema = {
      {"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  if (!partial && !required_keys.empty()) schema["required"] = required_keys;
  return schema;
}

Json by_include(const std::function<Json(bool)>& make) {
  return {{"if", {{"type", "object"}, {"required", {"include"}}}},
          {"then", make(true)},
          {"else", make(false)}};
}

Json parameter_schema(const ParameterSpec& spec, bool partial) {
  std::vector<Json> choices = {value_schema(spec, partial)};
  if (!is_group(spec)) {
    Json sourced = reference("sourced");
    sourced["properties"] = {{"value", choices.front()}};
    choices.push_back(std::move(sourced));
    if (partial) choices.push_back(reference("source_only"));
  }
  if (partial) choices.push_back({{"type", "null"}});
  Json schema = choices.size() == 1 ? choices.front() : any_of(std::move(choices));
  describe(schema, spec);
  return schema;
}

std::vector<std::string> required_names(const std::vector<ParameterSpec>& fields) {
  std::vector<std::string> names;
  for (const ParameterSpec& field : fields) {
    if (field.required) names.push_back(field.name);
  }
  return names;
}

Json properties_of(const std::vector<ParameterSpec>& fields, bool partial,
                   const std::string& definition) {
  Json properties = Json::object();
  for (const ParameterSpec& field : fields) {
    properties[field.name] = partial && !definition.empty()
                                 ? partial_parameter_schema(field, definition)
                                 : parameter_schema(field, partial);
    if (field.former_name.empty()) continue;
    Json& former = properties[field.former_name] = properties[field.name];
    former["deprecated"] = true;
    former["description"] = "former name of " + field.name;
  }
  return properties;
}

Json group_schema(const std::vector<ParameterSpec>& fields, bool partial) {
  return object_of(properties_of(fields, partial, ""), required_names(fields), partial);
}

Json value_schema(const ParameterSpec& spec, bool partial) {
  switch (spec.kind) {
    case ParameterKind::kNumber:
      return range({{"type", "number"}}, spec);
    case ParameterKind::kInteger:
      return range({{"type", "integer"}}, spec);
    case ParameterKind::kBoolean:
      return {{"type", "boolean"}};
    case ParameterKind::kText:
      return choices_of(spec);
    case ParameterKind::kPath:
      return {{"type", "string"}, {"minLength", 1}};
    case ParameterKind::kNumberList: {
      Json schema = {{"type", "array"}, {"items", range({{"type", "number"}}, spec)}};
      if (spec.size > 0) schema["minItems"] = schema["maxItems"] = spec.size;
      return schema;
    }
    case ParameterKind::kTextList:
      return {{"type", "array"}, {"items", choices_of(spec)}};
    case ParameterKind::kGroup:
      if (partial) return group_schema(spec.fields, true);
      return by_include([&](bool part) { return group_schema(spec.fields, part); });
    case ParameterKind::kGroupList:
      // Lists are replaced, not merged, so their entries must be complete unless they use
      // `include`.
      return {{"type", "array"},
              {"items", by_include([&](bool part) { return group_schema(spec.fields, part); })}};
  }
  return true;
}

Json base_definitions() {
  Json definitions;
  definitions["include"] = include_schema();
  definitions["include"]["description"] =
      "file or files whose contents this mapping takes over; keys given here override them";
  const Json text = {{"type", "string"}, {"minLength", 1}};
  definitions["sourced"] = object_of({{"value", true}, {"source", text}}, {}, true);
  definitions["sourced"]["anyOf"] = {{{"required", {"value"}}}, {{"required", {"include"}}}};
  definitions["sourced"]["description"] = "a value and its source";
  definitions["source_only"] = object_of({{"source", text}}, {"source"}, false);
  return definitions;
}

}  // namespace vinerow::scenario
