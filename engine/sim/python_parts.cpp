#include "engine/sim/python_parts.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <atomic>
#include <mutex>
#include <string>

#include "engine/core/error.h"
#include "engine/core/own_libraries.h"

namespace vinerow {
namespace {

constexpr const char* kHostName = "libvinerow_python_host.so";

std::atomic<const PythonParts*> python_parts = nullptr;

/// @throws ConfigError with the reason why there is no interpreter
void start_interpreter(const std::filesystem::path& file) {
  const auto fail = [&file](const std::string& reason) {
    throw ConfigError(
        fmt::format("plug-in '{}' is written in Python, but {}", file.string(), reason));
  };
  const std::filesystem::path host = find_own_library(kHostName);
  if (!std::filesystem::exists(host)) {
    fail(fmt::format("{} is missing; install python3-vinerow", host.string()));
  }
  // Python's extension modules find the interpreter among the global symbols. Its own libraries
  // come first: sin in a part is then that of the machine's C library, as in any interpreter, and
  // not the simulator's.
  void* library = dlopen(host.c_str(), RTLD_NOW | RTLD_GLOBAL | own_libraries_first());
  if (!library) fail(fmt::format("its interpreter cannot be loaded: {}", dlerror()));
  using Start = const char* (*)();
  const auto start = reinterpret_cast<Start>(dlsym(library, "vinerow_python_start"));
  if (!start) fail(fmt::format("{} is not of this vinerow", host.string()));
  if (const char* reason = start()) fail(reason);
  if (!python_parts) fail("the Python package vinerow that it found is of another vinerow");
}

}  // namespace

void set_python_parts(const PythonParts* parts) {
  python_parts = parts;
}

void load_python_parts(const std::filesystem::path& file, Registry& registry) {
  {
    static std::mutex starting;
    const std::lock_guard lock(starting);
    if (!python_parts) start_interpreter(file);
  }
  python_parts.load()->load(file, registry);
}

void interrupt_python_part() {
  if (const PythonParts* parts = python_parts) parts->interrupt();
}

}  // namespace vinerow
