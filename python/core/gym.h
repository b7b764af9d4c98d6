#pragma once
/// Environments for learning. python/vinerow/gym has the public classes.

#include <pybind11/pybind11.h>

namespace vinerow::python {

void bind_gym(pybind11::module_& module);

}  // namespace vinerow::python
