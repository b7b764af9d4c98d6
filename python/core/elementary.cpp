#include "python/core/elementary.h"

#include <pybind11/numpy.h>

#include <cmath>

namespace vinerow::python {
namespace py = pybind11;

void bind_elementary(py::module_& module) {
  // Of libvinerow.so, which precedes the C library here.
#define VINEROW_FUNCTION(name) \
  module.def(#name, py::vectorize([](double x) { return std::name(x); }), py::arg("x"))
#define VINEROW_FUNCTION_OF_TWO(name, first, second)                                   \
  module.def(#name, py::vectorize([](double a, double b) { return std::name(a, b); }), \
             py::arg(first), py::arg(second))
  VINEROW_FUNCTION(sin);
  VINEROW_FUNCTION(cos);
  VINEROW_FUNCTION(tan);
  VINEROW_FUNCTION(asin);
  VINEROW_FUNCTION(acos);
  VINEROW_FUNCTION(atan);
  VINEROW_FUNCTION(sinh);
  VINEROW_FUNCTION(cosh);
  VINEROW_FUNCTION(tanh);
  VINEROW_FUNCTION(exp);
  VINEROW_FUNCTION(expm1);
  VINEROW_FUNCTION(log);
  VINEROW_FUNCTION(log2);
  VINEROW_FUNCTION(log10);
  VINEROW_FUNCTION(log1p);
  VINEROW_FUNCTION(cbrt);
  VINEROW_FUNCTION(erf);
  VINEROW_FUNCTION_OF_TWO(atan2, "y", "x");
  VINEROW_FUNCTION_OF_TWO(hypot, "x", "y");
  VINEROW_FUNCTION_OF_TWO(pow, "x", "y");
#undef VINEROW_FUNCTION
#undef VINEROW_FUNCTION_OF_TWO
}

}  // namespace vinerow::python
