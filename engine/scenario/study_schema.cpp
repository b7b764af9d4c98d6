// JSON Schema (draft 2020-12) of study files, from the tables that the loader uses.
#include <nlohmann/json.hpp>

#include "engine/api/parameter_table.h"
#include "engine/scenario/scenario_keys.h"
#include "engine/scenario/schema_parts.h"
#include "engine/scenario/study.h"
#include "engine/scenario/study_factor.h"
#include "engine/scenario/study_keys.h"

namespace vinerow::scenario {
namespace {

Json mapping_of(Json values, const char* description) {
  return {{"type", "object"},
          {"minProperties", 1},
          {"additionalProperties", std::move(values)},
          {"description", description}};
}

Json list_of(Json items) {
  return {{"type", "array"}, {"minItems", 1}, {"items", std::move(items)}};
}

Json with(Json properties, const Json& more) {
  properties.update(more);
  return properties;
}

std::vector<std::string> with(std::vector<std::string> names, const char* more) {
  names.emplace_back(more);
  return names;
}

/// Forms of a factor; each has a key that no other form has.
Json factor_schema() {
  const Json key = {{"type", "string"},
                    {"minLength", 1},
                    {"description", "path of a parameter: rover.controller.lookahead_m"}};
  const Json range = properties_of(factor_range_table().specs(), false, "");
  const std::vector<std::string> ends = required_names(factor_range_table().specs());
  const Json steps = properties_of(range_steps_table().specs(), false, "");
  const Json sample = properties_of(sample_table().specs(), false, "");
  const Json any_values = {{"type", "object"}};

  const Json by_values =
      object_of({{"key", key}, {"values", list_of(Json::object())}}, {"key", "values"}, false);
  Json by_range = object_of(with(with({{"key", key}}, range), steps), with(ends, "key"), false);
  by_range["oneOf"] = {{{"required", {"step"}}}, {{"required", {"count"}}}};
  const Json by_alternatives =
      object_of({{"alternatives", mapping_of(any_values, "name to values: key path to value")}},
                {"alternatives"}, false);
  const Json by_zip = object_of(
      {{"zip",
        mapping_of(list_of(Json::object()), "key path to values, all lists of the same length")}},
      {"zip"}, false);
  const Json by_sample = object_of(
      with({{"ranges", mapping_of(object_of(range, ends, false), "key path to range")}}, sample),
      with(required_names(sample_table().specs()), "ranges"), false);
  return any_of({by_values, by_range, by_alternatives, by_zip, by_sample});
}

Json free_key_schema(const FreeStudyKey& key) {
  const char* words = key.description.c_str();
  if (key.name == "factors") {
    Json schema = {{"type", "object"},
                   {"propertyNames", {{"pattern", kNamePattern}}},
                   {"additionalProperties", reference("factor")}};
    schema["description"] = words;
    return schema;
  }
  if (key.name == "seeds") {
    const Json seed = {{"type", "integer"}, {"minimum", 0}};
    Json schema =
        any_of({Json{{"type", "integer"}, {"minimum", 1}, {"maximum", kMaxCells}}, list_of(seed)});
    schema["description"] = words;
    return schema;
  }
  if (key.name == "derived") {
    Json schema = {{"type", "object"},
                   {"propertyNames", {{"pattern", kNamePattern}}},
                   {"additionalProperties", {{"type", {"string", "number"}}}}};
    schema["description"] = words;
    return schema;
  }
  return {{"type", "object"}, {"description", words}};  // set: its keys are those of the scenario
}

}  // namespace

std::string study_json_schema() {
  Json properties = properties_of(study_table().specs(), false, "");
  properties["vinerow_study"] = {{"const", kStudyVersion}};
  for (const FreeStudyKey& key : free_study_keys()) properties[key.name] = free_key_schema(key);
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"title", "Vinerow study"},
                 {"description", "A study of the Vinerow simulator, format version " +
                                     std::to_string(kStudyVersion)}};
  schema.update(object_of(std::move(properties), required_names(study_table().specs()), false));
  schema["$defs"] = base_definitions();
  schema["$defs"]["factor"] = factor_schema();
  return schema.dump(1) + "\n";
}

}  // namespace vinerow::scenario
