// JSON Schema (draft 2020-12) of scenario files, from the tables that the loader reads too.
//
// A mapping that includes a file may leave out whatever the file may give, on every level below. So
// each mapping comes in two forms: complete, and partial ("..._partial"), which asks for nothing
// and allows `null`, which takes an included key away. `include` chooses.
#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/api/parameter_limits.h"
#include "engine/api/parameter_table.h"
#include "engine/io/scenario.h"
#include "engine/io/scenario_keys.h"
#include "engine/io/scenario_reader.h"

namespace vinerow::io {
namespace {

using Json = nlohmann::ordered_json;

Json any_of(std::vector<Json> choices) {
  return {{"anyOf", std::move(choices)}};
}

Json or_null(Json schema) {
  return any_of({std::move(schema), Json{{"type", "null"}}});
}

Json reference(const std::string& name) {
  return {{"$ref", "#/$defs/" + name}};
}

Json range(Json schema, const ParameterSpec& given) {
  ParameterSpec spec = with_limits_of_unit(given);
  if (given.min_exclusive) {  // "> 0" says more than the least number that is still taken
    spec.min = given.min;
    spec.min_exclusive = true;
  }
  const auto bound = [](double value) -> Json {
    // Whole numbers without point and exponent, as a person would write them.
    if (value == std::floor(value) && std::abs(value) < 9e15) {
      return static_cast<std::int64_t>(value);
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

/// The mapping that starts most schemas: these keys, `include`, and nothing else.
Json object_of(Json properties, const std::vector<std::string>& required_keys, bool partial) {
  properties["include"] = reference("include");
  Json schema = {
      {"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  if (!partial && !required_keys.empty()) schema["required"] = required_keys;
  return schema;
}

/// One schema that is complete without `include` and partial with it. @param make  makes it, given
/// `partial`
Json by_include(const std::function<Json(bool)>& make) {
  return {{"if", {{"type", "object"}, {"required", {"include"}}}},
          {"then", make(true)},
          {"else", make(false)}};
}

Json group_schema(const std::vector<ParameterSpec>& fields, bool partial);

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
      // Lists are replaced, not merged, so that their entries are complete unless they include.
      return {{"type", "array"},
              {"items", by_include([&](bool part) { return group_schema(spec.fields, part); })}};
  }
  return true;
}

bool is_group(const ParameterSpec& spec) {
  return spec.kind == ParameterKind::kGroup || spec.kind == ParameterKind::kGroupList;
}

/// A value, or {value, source}.
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

/// What may stand in a partial mapping for a parameter that the complete one, in `definition`,
/// describes.
Json partial_parameter_schema(const ParameterSpec& spec, const std::string& definition) {
  if (is_group(spec)) return parameter_schema(spec, true);
  Json schema = any_of({reference(definition + "/properties/" + spec.name),
                        reference("source_only"), Json{{"type", "null"}}});
  schema["description"] = describe_text(spec);
  return schema;
}

std::vector<std::string> required_names(const std::vector<ParameterSpec>& fields) {
  std::vector<std::string> names;
  for (const ParameterSpec& field : fields) {
    if (field.required) names.push_back(field.name);
  }
  return names;
}

/// @param definition  where the complete form is defined, so that the partial one can refer to it
Json properties_of(const std::vector<ParameterSpec>& fields, bool partial,
                   const std::string& definition) {
  Json properties = Json::object();
  for (const ParameterSpec& field : fields) {
    properties[field.name] = partial && !definition.empty()
                                 ? partial_parameter_schema(field, definition)
                                 : parameter_schema(field, partial);
  }
  return properties;
}

Json group_schema(const std::vector<ParameterSpec>& fields, bool partial) {
  return object_of(properties_of(fields, partial, ""), required_names(fields), partial);
}

class SchemaBuilder {
 public:
  explicit SchemaBuilder(const Registry& registry) : registry_(registry) {
    defs_["include"] = include_schema();
    defs_["include"]["description"] =
        "file or files whose contents this mapping takes over; keys given here win";
    const Json text = {{"type", "string"}, {"minLength", 1}};
    defs_["sourced"] = object_of({{"value", true}, {"source", text}}, {}, true);
    defs_["sourced"]["anyOf"] = {{{"required", {"value"}}}, {{"required", {"include"}}}};
    defs_["sourced"]["description"] = "a value and where it comes from";
    defs_["source_only"] = object_of({{"source", text}}, {"source"}, false);
  }

  Json build() {
    for (const PartKind kind : kAllPartKinds) define_parts(kind);
    define_cameras();
    define("phase", [&](bool partial) { return phase_schema(partial); });
    define("spawn", [&](bool partial) { return spawn_schema(partial); });
    define("scenario", [&](bool partial) { return keys_schema(scenario_keys(), {}, partial); });
    Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                   {"title", "Vinerow scenario"},
                   {"description", "A scenario of the Vinerow simulator, format version " +
                                       std::to_string(kFormatVersion)}};
    schema["$ref"] = "#/$defs/scenario";
    schema["$defs"] = std::move(defs_);
    return schema;
  }

 private:
  static std::string name_of(const std::string& name, bool partial) {
    return partial ? name + "_partial" : name;
  }

  void define(const std::string& name, const std::function<Json(bool)>& make) {
    defs_[name] = {{"if", {{"type", "object"}, {"required", {"include"}}}},
                   {"then", reference(name + "_partial")},
                   {"else", make(false)}};
    defs_[name + "_partial"] = make(true);
  }

  /// A mapping from free names to schemas of one definition.
  Json named(const std::string& definition, Json name_schema, bool partial) const {
    const auto make = [&](bool part) {
      return Json{{"type", "object"},
                  {"propertyNames", name_schema},
                  {"properties", {{"include", reference("include")}}},
                  {"additionalProperties", or_null(reference(name_of(definition, part)))}};
    };
    return partial ? make(true) : by_include(make);
  }

  Json key_schema(const StructuralKey& key, bool partial) const {
    const Json name = {{"type", "string"}, {"pattern", kNamePattern}};
    Json schema;
    switch (key.shape) {
      case KeyShape::kParameter:
        if (key.spec.name == "vinerow") return {{"const", kFormatVersion}};
        if (key.spec.name == "name") {  // empty: the file's
          schema = parameter_schema(key.spec, partial);
          schema["pattern"] = std::string("^$|") + kNamePattern;
          return schema;
        }
        return parameter_schema(key.spec, partial);
      case KeyShape::kGroup:
        schema = value_schema(key.spec, partial);
        break;
      case KeyShape::kGroupList:
        schema = criteria_schema(true);
        break;
      case KeyShape::kPart:
        schema = reference(name_of(to_string(key.part_kind), partial));
        break;
      case KeyShape::kNamedParts: {
        Json names = name;
        if (key.part_kind != PartKind::kMetric) {
          names["not"] = {{"enum", reserved_signal_names()}};
        }
        schema = named(to_string(key.part_kind), std::move(names), partial);
        break;
      }
      case KeyShape::kVehicles:
        schema = named("vehicle", name, partial);
        break;
      case KeyShape::kSpawn:
        schema = reference(name_of("spawn", partial));
        break;
      case KeyShape::kPictures: {
        const auto make = [&](bool part) { return keys_schema(pictures_keys(), {}, part); };
        schema = partial ? make(true) : by_include(make);
        break;
      }
      case KeyShape::kCameras:
        schema = named("camera", name, partial);
        break;
      case KeyShape::kPhases:
        schema = named("phase", name, partial);
        break;
      case KeyShape::kPathList:
        schema = {{"type", "array"}, {"items", {{"type", "string"}, {"minLength", 1}}}};
        break;
    }
    if (key.removable || partial) schema = or_null(std::move(schema));
    schema["description"] = key.spec.description;
    return schema;
  }

  /// Structural keys and, beside them, a part's own.
  Json keys_schema(const std::vector<StructuralKey>& keys, Json own_properties,
                   bool partial) const {
    Json properties = own_properties.is_null() ? Json::object() : std::move(own_properties);
    std::vector<std::string> required_keys;
    for (const StructuralKey& key : keys) {
      properties[key.spec.name] = key_schema(key, partial);
      if (key.spec.required) required_keys.push_back(key.spec.name);
    }
    return object_of(std::move(properties), required_keys, partial);
  }

  /// @param of_vehicle  "<vehicle>.<metric>", as the loader splits it; else a job's number, too
  Json criteria_schema(bool of_vehicle) const {
    const auto make = [of_vehicle](bool partial) {
      Json schema = group_schema(criterion_table().specs(), partial);
      schema["properties"]["metric"] = {{"type", "string"},
                                        {"pattern", of_vehicle ? "^[^.]+[.].+$" : "."}};
      if (!partial) schema["anyOf"] = {{{"required", {"min"}}}, {{"required", {"max"}}}};
      return schema;
    };
    return {{"type", "array"}, {"items", by_include(make)}};
  }

  /// Which of the keys fit a job or vehicles is the loader's to say.
  Json phase_schema(bool partial) const {
    Json properties = properties_of(phase_table().specs(), partial, "");
    properties["job"] = reference(name_of("job", partial));
    properties["criteria"] = criteria_schema(false);
    for (const ProductPort& port : product_ports(registry_)) {
      properties[port.key] = {
          {"type", "string"}, {"pattern", "^from [^ ]+$"}, {"description", port.description}};
    }
    return object_of(std::move(properties), {}, partial);
  }

  Json spawn_schema(bool partial) const {
    Json all = Json::object();
    std::vector<Json> forms;
    for (const SpawnForm& form : spawn_forms()) {
      Json schema = group_schema(form.fields, partial);
      if (form.name == "point")
        schema["properties"]["point"] = {{"type", "string"}, {"minLength", 1}};
      for (const auto& [key, value] : schema["properties"].items()) all[key] = value;
      forms.push_back(std::move(schema));
    }
    if (partial) return object_of(std::move(all), {}, true);
    return any_of(std::move(forms));
  }

  Json part_schema(PartKind kind, const PartSpec& spec, bool partial) const {
    Json properties = {{"type", {{"const", spec.name}, {"description", spec.description}}}};
    std::vector<std::string> required_keys = {"type"};
    std::vector<ParameterSpec> fields = spec.parameters;
    const bool has_own = std::any_of(fields.begin(), fields.end(),
                                     [](const ParameterSpec& f) { return f.name == "rate_Hz"; });
    if (has_rate(kind) && !has_own) fields.insert(fields.begin(), rate_field(kind, spec));
    const std::string definition = std::string(to_string(kind)) + "." + spec.name;
    properties.update(properties_of(fields, partial, definition));
    for (const std::string& name : required_names(fields)) required_keys.push_back(name);
    if (kind != PartKind::kVehicle) return object_of(properties, required_keys, partial);
    Json schema = keys_schema(vehicle_keys(), std::move(properties), partial);
    if (!partial) {
      for (const std::string& name : required_keys) schema["required"].push_back(name);
    }
    return schema;
  }

  /// Chooses by the value of `tag`; without the tag by `untagged`.
  static Json choose(const std::string& tag, const std::vector<std::string>& values,
                     const std::string& prefix, bool partial, Json untagged) {
    Json cases = Json::array();
    for (const std::string& value : values) {
      cases.push_back({{"if", {{"required", {tag}}, {"properties", {{tag, {{"const", value}}}}}}},
                       {"then", reference(name_of(prefix + "." + value, partial))}});
    }
    cases.push_back({{"if", {{"not", {{"required", {tag}}}}}}, {"then", std::move(untagged)}});
    return {{"type", "object"},
            {"properties", {{tag, {{"type", "string"}, {"enum", values}}}}},
            {"allOf", std::move(cases)}};
  }

  void define_parts(PartKind kind) {
    const std::string kind_name = to_string(kind);
    const std::vector<std::string> types = registry_.names(kind);
    std::set<std::string> all_keys = {"include"};
    for (const std::string& type : types) {
      const PartSpec& spec = registry_.spec(kind, type);
      for (const bool partial : {false, true}) {
        Json schema = part_schema(kind, spec, partial);
        for (const auto& [key, value] : schema["properties"].items()) all_keys.insert(key);
        defs_[name_of(kind_name + "." + type, partial)] = std::move(schema);
      }
    }
    define(kind_name, [&](bool partial) -> Json {
      // Without types nothing is allowed, and an empty enum is no schema.
      if (types.empty()) return {{"not", Json::object()}};
      Json untagged = {{"required", {"type"}}};
      if (partial) {
        untagged = {{"propertyNames", {{"enum", all_keys}}}};
        if (kind == PartKind::kVehicle) {
          // What a vehicle carries is known even where its type comes from an included file.
          untagged["properties"] = keys_schema(vehicle_keys(), {}, true)["properties"];
        }
      }
      return choose("type", types, kind_name, partial, untagged);
    });
  }

  void define_cameras() {
    std::set<std::string> all_keys = {"include"};
    for (const std::string& kind : camera_kinds()) {
      for (const bool partial : {false, true}) {
        Json properties = properties_of(camera_fields(kind), partial, "camera." + kind);
        properties["kind"] = {{"const", kind}};
        for (const auto& [key, value] : properties.items()) all_keys.insert(key);
        defs_[name_of("camera." + kind, partial)] =
            object_of(std::move(properties), required_names(camera_fields(kind)), partial);
      }
    }
    define("camera", [&](bool partial) {
      const Json untagged =
          partial ? Json{{"propertyNames", {{"enum", all_keys}}}} : reference("camera.chase");
      return choose("kind", camera_kinds(), "camera", partial, untagged);
    });
  }

  const Registry& registry_;
  Json defs_ = Json::object();
};

}  // namespace

std::string scenario_json_schema(const Registry& registry) {
  return SchemaBuilder(registry).build().dump(1) + "\n";
}

}  // namespace vinerow::io
