#pragma once
/// Loader of plug-ins: shared libraries that contain parts (engine/api/plugin.h), and Python files.

#include <filesystem>

#include "engine/api/registry.h"

namespace vinerow {

/// Registers the parts of a plug-in. A library stays loaded until the program ends; a file `.py`
/// runs afresh with each call.
/// @throws ConfigError with the file and the reason: it cannot be loaded, is not a Vinerow plug-in,
/// was built for another ABI (with both tags), threw in its registration, or registers a name that
/// is taken
void load_plugin(const std::filesystem::path& file, Registry& registry);

}  // namespace vinerow
