#pragma once
/// What a class of a Python file declares about itself.

#include <pybind11/pybind11.h>

#include "engine/api/registry.h"

namespace vinerow::python {

/// @param declaration  of vinerow._part_files
/// @throws ConfigError
PartSpec part_spec_of(const pybind11::handle& declaration);

}  // namespace vinerow::python
