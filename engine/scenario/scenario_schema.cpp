// JSON Schema (draft 2020-12) of scenario files, from the tables that the loader uses.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/api/parameter_table.h"
#include "engine/scenario/scenario.h"
#include "engine/scenario/scenario_keys.h"
#include "engine/scenario/scenario_reader.h"
#include "engine/scenario/schema_parts.h"

namespace vinerow::scenario {
namespace {

class SchemaBuilder {
 public:
  explicit SchemaBuilder(const Registry& registry) : registry_(registry) {}

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

  /// Mapping from free names to schemas of one definition.
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
        if (key.spec.name == "name") {  // empty: the file's name
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

  /// Structural keys and a part's own keys.
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

  /// @param of_vehicle  true: "<vehicle>.<metric>" as the loader splits it; false: also a job's
  /// number
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

  /// The loader checks which keys are allowed for a job and for vehicles.
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

  /// Selects a schema by the value of `tag`; `untagged` if there is no tag.
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
      // Without types nothing is allowed; an empty enum is not a valid schema.
      if (types.empty()) return {{"not", Json::object()}};
      Json untagged = {{"required", {"type"}}};
      if (partial) {
        untagged = {{"propertyNames", {{"enum", all_keys}}}};
        if (kind == PartKind::kVehicle) {
          // The parts of a vehicle are known even if its type comes from an included file.
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
  Json defs_ = base_definitions();
};

}  // namespace

std::string scenario_json_schema(const Registry& registry) {
  return SchemaBuilder(registry).build().dump(1) + "\n";
}

}  // namespace vinerow::scenario
