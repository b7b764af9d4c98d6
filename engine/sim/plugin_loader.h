#pragma once
/// Loads shared libraries that bring parts of their own (engine/api/plugin.h).

#include <filesystem>

#include "engine/api/registry.h"

namespace vinerow {

/// Registers the parts of a plug-in. The library stays loaded until the program ends.
/// @throws ConfigError naming the file and the reason: cannot be loaded, is no Vinerow plug-in, was
/// built for
///         another ABI (both tags are named), its registration threw, or it brings a name that is
///         taken
void load_plugin(const std::filesystem::path& file, Registry& registry);

}  // namespace vinerow
