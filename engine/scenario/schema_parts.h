#pragma once
/// Pieces of the JSON Schemas of files that the scenario reader reads, from parameter specs.
///
/// A mapping that includes a file may leave out whatever the file may give, on every level below.
/// So each mapping comes in two forms: complete, and partial ("..._partial"), which asks for
/// nothing and allows `null`, which takes an included key away. `include` chooses.

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
/// To a definition.
Json reference(const std::string& name);

/// The mapping that starts most schemas: these keys, `include`, and nothing else.
Json object_of(Json properties, const std::vector<std::string>& required_keys, bool partial);

/// One schema that is complete without `include` and partial with it. @param make  makes it, given
/// `partial`
Json by_include(const std::function<Json(bool)>& make);

/// A value of the spec's kind and range.
Json value_schema(const ParameterSpec& spec, bool partial);

/// A value, or {value, source}.
Json parameter_schema(const ParameterSpec& spec, bool partial);

/// Of those that have no default.
std::vector<std::string> required_names(const std::vector<ParameterSpec>& fields);

/// The properties of a mapping of parameters.
/// @param definition  where the complete form is defined, so that the partial one can refer to it
Json properties_of(const std::vector<ParameterSpec>& fields, bool partial,
                   const std::string& definition);

/// A mapping of parameters.
Json group_schema(const std::vector<ParameterSpec>& fields, bool partial);

}  // namespace vinerow::scenario
