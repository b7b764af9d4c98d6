#pragma once
/// Parts of a scenario as Python classes (vinerow/parts.py), behind the interfaces of C++ parts.
///
/// A part's methods run with the interpreter's lock, which is taken for each call; sessions step
/// without it. Objects through which a part sees the run (readers, writers, the context) refuse
/// calls from other threads, and outside the part's own methods.

#include <pybind11/pybind11.h>

#include <exception>

namespace vinerow::python {

void bind_parts(pybind11::module_& module);

/// Whether Ctrl-C has ended a Python part in this thread since the last call.
bool take_interruption();

/// Runs work of a session without the interpreter's lock. If Ctrl-C ended a Python part in it, that
/// is a KeyboardInterrupt, as anywhere else in Python.
template <class Work>
auto without_lock(Work&& work) {
  static_cast<void>(take_interruption());
  try {
    const pybind11::gil_scoped_release release;
    return work();
  } catch (...) {
    if (!take_interruption()) throw;
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw pybind11::error_already_set();
  }
}

}  // namespace vinerow::python
