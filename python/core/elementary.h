#pragma once
/// vinerow.elementary: the simulator's elementary functions (engine/elementary) for arrays.

#include <pybind11/pybind11.h>

namespace vinerow::python {

void bind_elementary(pybind11::module_& module);

}  // namespace vinerow::python
