#pragma once
/// Specs without a struct, for tests of what stands on specs. Parts take theirs from a table.

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "engine/api/parameters.h"

namespace vinerow {

inline ParameterSpec make_spec(std::string name, ParameterKind kind, std::string unit,
                               std::string description) {
  ParameterSpec spec;
  spec.name = std::move(name);
  spec.kind = kind;
  spec.unit = std::move(unit);
  spec.description = std::move(description);
  return spec;
}

inline ParameterSpec number_parameter(std::string name, std::string unit, double default_value,
                                      double min, double max, std::string description) {
  ParameterSpec spec =
      make_spec(std::move(name), ParameterKind::kNumber, std::move(unit), std::move(description));
  spec.min = min;
  spec.max = max;
  spec.default_value = default_value;
  return spec;
}

inline ParameterSpec positive_parameter(std::string name, std::string unit, double default_value,
                                        std::string description) {
  ParameterSpec spec =
      number_parameter(std::move(name), std::move(unit), default_value, 0.0,
                       std::numeric_limits<double>::infinity(), std::move(description));
  spec.min_exclusive = true;
  return spec;
}

inline ParameterSpec integer_parameter(std::string name, std::int64_t default_value, double min,
                                       double max, std::string description) {
  ParameterSpec spec =
      make_spec(std::move(name), ParameterKind::kInteger, "", std::move(description));
  spec.min = min;
  spec.max = max;
  spec.default_value = default_value;
  return spec;
}

inline ParameterSpec boolean_parameter(std::string name, bool default_value,
                                       std::string description) {
  ParameterSpec spec =
      make_spec(std::move(name), ParameterKind::kBoolean, "", std::move(description));
  spec.default_value = default_value;
  return spec;
}

inline ParameterSpec text_parameter(std::string name, std::string default_value,
                                    std::string description) {
  ParameterSpec spec = make_spec(std::move(name), ParameterKind::kText, "", std::move(description));
  spec.default_value = std::move(default_value);
  return spec;
}

inline ParameterSpec choice_parameter(std::string name, std::string default_value,
                                      std::vector<std::string> choices, std::string description) {
  ParameterSpec spec =
      text_parameter(std::move(name), std::move(default_value), std::move(description));
  spec.choices = std::move(choices);
  return spec;
}

inline ParameterSpec path_parameter(std::string name, std::string description) {
  return make_spec(std::move(name), ParameterKind::kPath, "", std::move(description));
}

inline ParameterSpec number_list_parameter(std::string name, std::string unit,
                                           std::vector<double> default_value,
                                           std::string description, int size = 0) {
  ParameterSpec spec = make_spec(std::move(name), ParameterKind::kNumberList, std::move(unit),
                                 std::move(description));
  spec.default_value = std::move(default_value);
  spec.size = size;
  return spec;
}

inline ParameterSpec text_list_parameter(std::string name, std::vector<std::string> default_value,
                                         std::string description) {
  ParameterSpec spec =
      make_spec(std::move(name), ParameterKind::kTextList, "", std::move(description));
  spec.default_value = std::move(default_value);
  return spec;
}

inline ParameterSpec group_list_parameter(std::string name, std::vector<ParameterSpec> fields,
                                          std::string description) {
  ParameterSpec spec =
      make_spec(std::move(name), ParameterKind::kGroupList, "", std::move(description));
  spec.fields = std::move(fields);
  return spec;
}

inline ParameterSpec group_parameter(std::string name, std::vector<ParameterSpec> fields,
                                     std::string description) {
  ParameterSpec spec =
      make_spec(std::move(name), ParameterKind::kGroup, "", std::move(description));
  spec.fields = std::move(fields);
  return spec;
}

inline ParameterSpec required(ParameterSpec spec) {
  spec.required = true;
  spec.default_value = std::monostate{};
  return spec;
}

}  // namespace vinerow
