#include "engine/sim/plugin_loader.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <string>

#include "engine/api/plugin.h"
#include "engine/core/error.h"
#include "engine/core/own_libraries.h"
#include "engine/sim/abi_difference.h"
#include "engine/sim/python_parts.h"

namespace vinerow {
namespace {

/// Calls a function that registers parts of this origin.
template <class Register>
void register_from(const std::string& origin, Registry& registry, Register&& add_parts) {
  registry.set_origin(origin);
  try {
    add_parts();
  } catch (...) {
    registry.set_origin("built-in");
    throw;
  }
  registry.set_origin("built-in");
}

}  // namespace

void load_plugin(const std::filesystem::path& file, Registry& registry) {
  if (!std::filesystem::exists(file)) {
    throw ConfigError(fmt::format("plug-in '{}' does not exist", file.string()));
  }
  if (file.extension() == ".py") {
    return register_from(file.string(), registry, [&] { load_python_parts(file, registry); });
  }
  // A bare name would be searched in the system's library folders.
  const std::string path = std::filesystem::absolute(file).string();
  // A plug-in must call the simulator's elementary functions (engine/elementary). The command loads
  // them before the C library; an interpreter that imports the simulator does not.
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | own_libraries_first());
  if (!library)
    throw ConfigError(fmt::format("plug-in '{}' cannot be loaded: {}", file.string(), dlerror()));

  using AbiFunction = const char* (*)();
  using RegisterFunction = void (*)(Registry*);
  const auto abi = reinterpret_cast<AbiFunction>(dlsym(library, "vinerow_plugin_abi"));
  const auto registration =
      reinterpret_cast<RegisterFunction>(dlsym(library, "vinerow_plugin_register"));
  if (!abi || !registration) {
    throw ConfigError(fmt::format(
        "'{}' is not a Vinerow plug-in: it has no VINEROW_PLUGIN(...) line", file.string()));
  }
  const std::string difference = abi_difference(abi(), VINEROW_ABI_TAG);
  if (!difference.empty()) {
    throw ConfigError(
        fmt::format("plug-in '{}' {}; rebuild it with the headers and flags of this vinerow",
                    file.string(), difference));
  }
  register_from(file.string(), registry, [&] {
    try {
      registration(&registry);
    } catch (const ConfigError&) {
      throw;
    } catch (const std::exception& error) {
      throw ConfigError(fmt::format("plug-in '{}' failed to register its parts: {}", file.string(),
                                    error.what()));
    }
  });
}

}  // namespace vinerow
