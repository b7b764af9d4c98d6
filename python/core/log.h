#pragma once
/// Logs as arrays.

#include <pybind11/pybind11.h>

namespace vinerow::python {

void bind_log(pybind11::module_& module);

}  // namespace vinerow::python
