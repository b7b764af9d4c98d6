#pragma once
/// A second reader of JSON Schema, independent of the loader: the keywords that our schema uses,
/// and no more. An unknown keyword fails loudly, so that the schema cannot come to rely on
/// something that is not checked.

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>

namespace vinerow::scenario::test {

class SchemaValidator {
 public:
  explicit SchemaValidator(nlohmann::json schema) : root_(std::move(schema)) {}

  bool accepts(const nlohmann::json& value) const { return accepts(root_, value); }

 private:
  using Json = nlohmann::json;

  static bool has_type(const std::string& type, const Json& value) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "null") return value.is_null();
    if (type == "number") return value.is_number();
    if (type == "integer") {
      return value.is_number_integer() ||
             (value.is_number() && value.get<double>() == std::floor(value.get<double>()));
    }
    throw std::logic_error("unknown type " + type);
  }

  bool all_accept(const Json& schemas, const Json& value) const {
    for (const Json& schema : schemas) {
      if (!accepts(schema, value)) return false;
    }
    return true;
  }

  bool any_accepts(const Json& schemas, const Json& value) const {
    for (const Json& schema : schemas) {
      if (accepts(schema, value)) return true;
    }
    return false;
  }

  bool accepts_object(const Json& schema, const Json& value) const {
    const Json none = Json::object();
    const Json& properties = schema.contains("properties") ? schema["properties"] : none;
    for (const auto& [key, item] : value.items()) {
      if (properties.contains(key)) {
        if (!accepts(properties[key], item)) return false;
      } else if (schema.contains("additionalProperties") &&
                 !accepts(schema["additionalProperties"], item)) {
        return false;
      }
      if (schema.contains("propertyNames") && !accepts(schema["propertyNames"], key)) return false;
    }
    if (schema.contains("required")) {
      for (const Json& key : schema["required"]) {
        if (!value.contains(key.get<std::string>())) return false;
      }
    }
    return true;
  }

  bool accepts_array(const Json& schema, const Json& value) const {
    if (schema.contains("minItems") && value.size() < schema["minItems"].get<std::size_t>())
      return false;
    if (schema.contains("maxItems") && value.size() > schema["maxItems"].get<std::size_t>())
      return false;
    for (const Json& item : value) {
      if (schema.contains("items") && !accepts(schema["items"], item)) return false;
    }
    return true;
  }

  bool accepts_scalar(const Json& schema, const Json& value) const {
    if (value.is_number()) {
      const double number = value.get<double>();
      if (schema.contains("minimum") && number < schema["minimum"].get<double>()) return false;
      if (schema.contains("maximum") && number > schema["maximum"].get<double>()) return false;
      if (schema.contains("exclusiveMinimum") &&
          number <= schema["exclusiveMinimum"].get<double>()) {
        return false;
      }
    }
    if (value.is_string()) {
      const std::string text = value.get<std::string>();
      if (schema.contains("minLength") && text.size() < schema["minLength"].get<std::size_t>())
        return false;
      if (schema.contains("pattern") &&
          !std::regex_search(text, std::regex(schema["pattern"].get<std::string>()))) {
        return false;
      }
    }
    return true;
  }

  bool accepts(const Json& schema, const Json& value) const {
    if (schema.is_boolean()) return schema.get<bool>();
    static const std::set<std::string> known = {"$schema",
                                                "$defs",
                                                "$ref",
                                                "title",
                                                "description",
                                                "default",
                                                "type",
                                                "enum",
                                                "const",
                                                "properties",
                                                "additionalProperties",
                                                "propertyNames",
                                                "required",
                                                "items",
                                                "minItems",
                                                "maxItems",
                                                "minimum",
                                                "maximum",
                                                "exclusiveMinimum",
                                                "minLength",
                                                "pattern",
                                                "anyOf",
                                                "allOf",
                                                "not",
                                                "if",
                                                "then",
                                                "else"};
    for (const auto& [keyword, unused] : schema.items()) {
      if (!known.contains(keyword)) throw std::logic_error("unknown keyword " + keyword);
    }
    if (schema.contains("$ref")) {
      const std::string pointer = schema["$ref"].get<std::string>().substr(1);
      if (!accepts(root_.at(Json::json_pointer(pointer)), value)) return false;
    }
    if (schema.contains("type") && !has_type(schema["type"].get<std::string>(), value))
      return false;
    if (schema.contains("const") && value != schema["const"]) return false;
    if (schema.contains("enum")) {
      bool found = false;
      for (const Json& choice : schema["enum"]) found = found || choice == value;
      if (!found) return false;
    }
    if (schema.contains("anyOf") && !any_accepts(schema["anyOf"], value)) return false;
    if (schema.contains("allOf") && !all_accept(schema["allOf"], value)) return false;
    if (schema.contains("not") && accepts(schema["not"], value)) return false;
    if (schema.contains("if")) {
      const char* branch = accepts(schema["if"], value) ? "then" : "else";
      if (schema.contains(branch) && !accepts(schema[branch], value)) return false;
    }
    if (value.is_object()) return accepts_object(schema, value);
    if (value.is_array()) return accepts_array(schema, value);
    return accepts_scalar(schema, value);
  }

  Json root_;
};

}  // namespace vinerow::scenario::test
