#include "python/core/part_declaration.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "engine/core/error.h"
#include "python/core/part_life.h"

namespace vinerow::python {
namespace py = pybind11;
namespace {

/// Default of a parameter as a value of its kind.
/// @throws ConfigError "must be a number, not str"
ParameterSet::Value value_from(const py::handle& value, ParameterKind kind) {
  const auto cast = [&value]<class T>(T*, const char* wanted) {
    const bool is_bool = py::isinstance<py::bool_>(value);
    try {
      if (is_bool == std::is_same_v<T, bool>) return value.cast<T>();
    } catch (const py::cast_error&) {
    }
    throw ConfigError(fmt::format("must be {}, not {}", wanted, type_of_value(value)));
  };
  switch (kind) {
    case ParameterKind::kNumber:
      return cast(static_cast<double*>(nullptr), "a number");
    case ParameterKind::kInteger:
      return cast(static_cast<std::int64_t*>(nullptr), "a whole number");
    case ParameterKind::kBoolean:
      return cast(static_cast<bool*>(nullptr), "True or False");
    case ParameterKind::kNumberList:
      return cast(static_cast<std::vector<double>*>(nullptr), "a list of numbers");
    case ParameterKind::kTextList:
      return cast(static_cast<std::vector<std::string>*>(nullptr), "a list of texts");
    default:
      return cast(static_cast<std::string*>(nullptr), "a text");
  }
}

ParameterKind kind_named(const std::string& name) {
  if (name == "number") return ParameterKind::kNumber;
  if (name == "integer") return ParameterKind::kInteger;
  if (name == "boolean") return ParameterKind::kBoolean;
  if (name == "numbers") return ParameterKind::kNumberList;
  if (name == "texts") return ParameterKind::kTextList;
  return name == "path" ? ParameterKind::kPath : ParameterKind::kText;
}

ParameterSpec spec_of(const std::string& name, const py::handle& parameter) {
  ParameterSpec spec;
  spec.name = name;
  try {
    spec.kind = kind_named(parameter.attr("kind").cast<std::string>());
    spec.unit = parameter.attr("unit").cast<std::string>();
    spec.description = parameter.attr("words").cast<std::string>();
    spec.size = parameter.attr("size").cast<int>();
    spec.choices = parameter.attr("choices").cast<std::vector<std::string>>();
    const py::object low = parameter.attr("low"), high = parameter.attr("high");
    if (!low.is_none()) spec.min = low.cast<double>();
    if (!high.is_none()) spec.max = high.cast<double>();
    spec.min_exclusive = parameter.attr("low_excluded").cast<bool>();
  } catch (const py::cast_error&) {
    throw ConfigError(fmt::format(
        "parameter '{}': unit and words must be texts, limits numbers, size a whole number", name));
  }
  const py::object given = parameter.attr("default");
  spec.required = given.is(py::module_::import("vinerow.parts").attr("REQUIRED"));
  if (spec.required || given.is_none()) return spec;
  try {
    const ParameterSet::Value value = value_from(given, spec.kind);
    check_parameter(spec, value);
    std::visit(
        [&spec]<class T>(const T& v) {
          if constexpr (!std::is_same_v<T, std::vector<ParameterSet>>) spec.default_value = v;
        },
        value);
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    throw ConfigError(text.starts_with("must") ? fmt::format("the default of '{}' {}", name, text)
                                               : "the default " + text);
  }
  return spec;
}

std::vector<std::string> texts_of(const py::handle& list, const char* what) {
  try {
    return list.cast<std::vector<std::string>>();
  } catch (const py::cast_error&) {
    throw ConfigError(fmt::format("{} must be a list of names of signals", what));
  }
}

}  // namespace

PartSpec part_spec_of(const py::handle& declaration) {
  PartSpec spec;
  spec.name = declaration.attr("name").cast<std::string>();
  spec.description = py::str(declaration.attr("words"));
  spec.default_rate_Hz = declaration.attr("rate_Hz").cast<double>();
  spec.reads = texts_of(declaration.attr("reads"), "reads");
  spec.writes = texts_of(declaration.attr("writes"), "writes");
  for (const py::handle entry : declaration.attr("parameters")) {
    const auto pair = py::reinterpret_borrow<py::tuple>(entry);
    spec.parameters.push_back(spec_of(pair[0].cast<std::string>(), pair[1]));
  }
  return spec;
}

}  // namespace vinerow::python
