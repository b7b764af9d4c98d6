#pragma once
/// Building blocks of the JSON Schemas of scenario and study files, made from parameter specs.
///
/// A mapping with `include` may omit all keys that the included file may have, on every level
/// below. Each mapping therefore has two schemas: the complete one, and the partial one
/// ("..._partial") for mappings with `include`. The partial schema requires no key and allows
/// `null`, which removes an included key.

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/api/parameters.h"

namespace vinerow::scenario {

using Json = nlohmann::ordered_json;

/// Definitions that the pieces below refer to: include, sourced, source_only.
Json base_definitions();

Json any_of(std::vector<Json> choices);
Json or_null(Json schema);
/// Reference to a definition.
Json reference(const std::string& name);

/// Mapping with these keys and `include`, and no others.
Json object_of(Json properties, const std::vector<std::string>& required_keys, bool partial);

/// Schema that is complete without `include` and partial with it. @param make  returns the schema
/// for `partial`
Json by_include(const std::function<Json(bool)>& make);

/// Schema of a value of the spec's kind and range.
Json value_schema(const ParameterSpec& spec, bool partial);

/// Schema of a value, or of {value, source}.
Json parameter_schema(const ParameterSpec& spec, bool partial);

/// Names of the fields without default.
std::vector<std::string> required_names(const std::vector<ParameterSpec>& fields);

/// Properties of a mapping of parameters.
/// @param definition  name of the complete form, to which the partial one refers
Json properties_of(const std::vector<ParameterSpec>& fields, bool partial,
                   const std::string& definition);

/// Schema of a mapping of parameters.
Json group_schema(const std::vector<ParameterSpec>& fields, bool partial);

}  // namespace vinerow::scenario
