/// libvinerow_python_host.so: an interpreter for programs that are not one, for parts written in
/// Python (engine/sim/python_parts.h). Apart from it nothing links libpython.
///
/// The interpreter never ends: objects of parts may live as long as the program, and the program
/// then ends without it.

#include <Python.h>
#include <dlfcn.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "engine/core/own_libraries.h"

namespace vinerow::python {
namespace {

namespace fs = std::filesystem;

std::string failure;

/// The folder with the package `vinerow` that belongs to this library: of a build, of a wheel (the
/// package contains this library), of an installation. "" leaves it to the interpreter.
fs::path folder_of_package() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&folder_of_package), &info) == 0) return {};
  const fs::path here = fs::absolute(info.dli_fname).parent_path();
  for (const char* place :
       {"../python", "..", "python3/dist-packages", "../python3/dist-packages"}) {
    const fs::path folder = (here / place).lexically_normal();
    if (fs::exists(folder / "vinerow" / "__init__.py")) return folder;
  }
  return {};
}

/// As `python3`: with PYTHONPATH and an active virtual environment, since parts import what the
/// user has installed. Without handlers of signals, which are the program's.
const char* initialise() {
  PyConfig config;
  PyConfig_InitPythonConfig(&config);
  config.install_signal_handlers = 0;
  config.parse_argv = 0;
  config.write_bytecode = 0;
  config.buffered_stdio = 0;
  const char* const environment = std::getenv("VIRTUAL_ENV");
  const fs::path own_python = fs::path(environment ? environment : "") / "bin/python3.11";
  const bool in_environment = environment && fs::exists(own_python);
  const std::string program = in_environment ? own_python.string() : "/usr/bin/python3";
  PyStatus status = PyConfig_SetBytesString(&config, &config.program_name, program.c_str());
  if (!PyStatus_Exception(status)) status = Py_InitializeFromConfig(&config);
  PyConfig_Clear(&config);
  if (!PyStatus_Exception(status)) return nullptr;
  failure = std::string("the interpreter does not start: ") +
            (status.err_msg ? status.err_msg : "for an unknown reason");
  return failure.c_str();
}

/// Text of the exception that is set, and clears it.
std::string take_exception() {
  PyObject *type = nullptr, *value = nullptr, *trace = nullptr;
  PyErr_Fetch(&type, &value, &trace);
  PyErr_NormalizeException(&type, &value, &trace);
  PyObject* text = value ? PyObject_Str(value) : nullptr;
  const char* bytes = text ? PyUnicode_AsUTF8(text) : nullptr;
  const std::string result = bytes ? bytes : "an unknown exception";
  Py_XDECREF(text), Py_XDECREF(type), Py_XDECREF(value), Py_XDECREF(trace);
  PyErr_Clear();
  return result;
}

/// Extension modules take elementary functions from their own libraries, as in any interpreter:
/// this program's own would give a part other bits than vinerow.open() does. Ctrl-C raises
/// KeyboardInterrupt where the program asks for it (PyErr_SetInterruptEx).
constexpr const char* kPreparation = R"(
import os, signal, sys
sys.setdlopenflags(os.RTLD_NOW | os.RTLD_LOCAL | own_first)
if folder:
    sys.path.insert(0, folder)
signal.signal(signal.SIGINT, signal.default_int_handler)
import vinerow
)";

const char* import_package() {
  struct sigaction handler {};
  sigaction(SIGINT, nullptr, &handler);
  PyObject* names = PyDict_New();
  PyObject* folder = PyUnicode_DecodeFSDefault(folder_of_package().c_str());
  PyDict_SetItemString(names, "__builtins__", PyEval_GetBuiltins());
  PyDict_SetItemString(names, "folder", folder);
  PyObject* own_first = PyLong_FromLong(own_libraries_first());
  PyDict_SetItemString(names, "own_first", own_first);
  PyObject* result = PyRun_String(kPreparation, Py_file_input, names, names);
  if (!result) {
    failure = "the package vinerow cannot be imported (" + take_exception() +
              "); install python3-vinerow";
  }
  Py_XDECREF(result), Py_XDECREF(own_first), Py_XDECREF(folder), Py_XDECREF(names);
  sigaction(SIGINT, &handler, nullptr);
  return failure.empty() ? nullptr : failure.c_str();
}

}  // namespace
}  // namespace vinerow::python

/// Starts the interpreter once and imports the package vinerow, which registers itself.
/// @returns nullptr, or the reason why there is none
extern "C" __attribute__((visibility("default"))) const char* vinerow_python_start() {
  using namespace vinerow::python;
  static const char* const result = []() -> const char* {
    const bool is_running = Py_IsInitialized() != 0;
    if (!is_running) {
      if (const char* reason = initialise()) return reason;
    }
    const PyGILState_STATE state = is_running ? PyGILState_Ensure() : PyGILState_UNLOCKED;
    const char* const reason = import_package();
    // Any thread may run a part.
    if (is_running) {
      PyGILState_Release(state);
    } else {
      PyEval_SaveThread();
    }
    return reason;
  }();
  return result;
}
