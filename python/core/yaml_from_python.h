#pragma once
/// Python values as YAML trees: scenarios and overrides that are dicts.

#include <pybind11/pybind11.h>

#include <string>

#include "engine/io/files/yaml.h"

namespace vinerow::python {

/// None, bool, int, float, str, paths, numpy scalars, and dicts, lists, tuples and arrays of these.
/// @param place  of the value, in errors. @throws ConfigError
io::YamlNode yaml_from_python(const pybind11::handle& value, const std::string& place);

}  // namespace vinerow::python
