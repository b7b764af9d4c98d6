/// The extension module vinerow._core. python/vinerow/__init__.py has the public names.

#include <pybind11/pybind11.h>

#include <string>

#include "engine/core/error.h"
#include "engine/io/files/placed_error.h"
#include "engine/io/files/plain_zeros.h"
#include "python/core/elementary.h"
#include "python/core/gym.h"
#include "python/core/log.h"
#include "python/core/parts.h"
#include "python/core/run.h"
#include "python/core/scenario.h"
#include "python/core/session.h"
#include "python/core/signal.h"
#include "python/core/usage_error.h"
#include "vinerow/version.h"

namespace py = pybind11;

namespace vinerow::python {
namespace {

/// Raises an exception of vinerow.errors.
template <class... Arguments>
void raise(const char* type, Arguments&&... arguments) {
  const py::object exception_type = py::module_::import("vinerow.errors").attr(type);
  const py::object exception = exception_type(std::forward<Arguments>(arguments)...);
  PyErr_SetObject(exception_type.ptr(), exception.ptr());
}

template <class T>
py::object or_none(const T& value, bool is_given) {
  return is_given ? py::cast(value) : py::object(py::none());
}

void translate(std::exception_ptr pointer) {
  try {
    if (pointer) std::rethrow_exception(pointer);
  } catch (const SimulationError& error) {
    raise("SimulationError", io::plain_zeros(error.what()), error.culprit(),
          error.time().nearest_s());
  } catch (const io::PlacedError& error) {
    const io::SourceMark& where = error.where();
    raise("ConfigError", io::plain_zeros(error.what()), or_none(where.file, !where.file.empty()),
          or_none(where.line, where.line > 0), or_none(error.key(), !error.key().empty()));
  } catch (const ConfigError& error) {
    raise("ConfigError", io::plain_zeros(error.what()));
  } catch (const UsageError& error) {
    raise("UsageError", error.what());
  }
}

/// Older pybind11 reads array types of NumPy 2 wrongly, without an error: every number of a column
/// would be the first one.
void check_numpy() {
#if PYBIND11_VERSION_HEX < 0x020C0000
  const std::string version =
      py::str(py::module_::import("numpy").attr("__version__").cast<py::object>());
  if (version.starts_with("0.") || version.starts_with("1.")) return;
  throw py::import_error("this build of vinerow needs NumPy 1, but this is NumPy " + version +
                         ": install 'numpy<2', or build vinerow with pybind11 2.12 or later, as "
                         "'pip install .' does");
#endif
}

}  // namespace
}  // namespace vinerow::python

PYBIND11_MODULE(_core, module) {
  module.doc() = "C++ part of vinerow.";
  vinerow::python::check_numpy();
  py::register_exception_translator(&vinerow::python::translate);
  module.attr("__version__") = VINEROW_VERSION_STRING;
  vinerow::python::bind_scenario(module);
  vinerow::python::bind_signal(module);
  vinerow::python::bind_session(module);
  vinerow::python::bind_elementary(module);
  vinerow::python::bind_log(module);
  vinerow::python::bind_gym(module);
  vinerow::python::bind_run(module);
  vinerow::python::bind_parts(module);
}
