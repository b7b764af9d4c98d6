#pragma once
/// Parts written in Python (python/core/parts.h). The simulator itself does not know Python: the
/// extension module of the package vinerow loads the parts. An interpreter that imports the package
/// has that module; other programs load libvinerow_python_host.so, which starts an interpreter.

#include <filesystem>

#include "engine/api/registry.h"

namespace vinerow {

/// What the extension module can do.
struct PythonParts {
  /// Registers the parts of a file. @throws ConfigError
  void (*load)(const std::filesystem::path& file, Registry& registry);
  /// Raises KeyboardInterrupt in a part that is running. Async-signal-safe.
  void (*interrupt)();
};

/// Called by the extension module when it is imported. @param parts  valid until the program ends
void set_python_parts(const PythonParts* parts);

/// Registers the parts of a file `.py`; starts an interpreter in a program without one.
/// @throws ConfigError with file and line, or if Python or the package is missing
void load_python_parts(const std::filesystem::path& file, Registry& registry);

/// For handlers of Ctrl-C: ends a Python part that does not return. Async-signal-safe.
void interrupt_python_part();

}  // namespace vinerow
