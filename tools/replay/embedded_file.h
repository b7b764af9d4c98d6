#pragma once
/// Files that the build embeds in the program (cmake/vinerow_assets.cmake).

#include <string_view>

namespace vinerow::tools {

struct EmbeddedFile {
  std::string_view name;  ///< "scene.js"
  std::string_view text;
};

}  // namespace vinerow::tools

/// Declares the symbols of vinerow_embed(), outside of namespaces.
#define VINEROW_ASSET(name)                     \
  extern "C" const char vinerow_asset_##name[]; \
  extern "C" const char vinerow_asset_##name##_end[]
#define VINEROW_ASSET_TEXT(name) \
  std::string_view(vinerow_asset_##name, vinerow_asset_##name##_end - vinerow_asset_##name)
