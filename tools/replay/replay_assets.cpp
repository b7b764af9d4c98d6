#include "tools/replay/replay_assets.h"

// Symbols of the assembly file that replay.cmake writes: start and end of each file.
#define VINEROW_ASSET(name)                     \
  extern "C" const char vinerow_asset_##name[]; \
  extern "C" const char vinerow_asset_##name##_end[]
#define VINEROW_ASSET_TEXT(name) \
  std::string_view(vinerow_asset_##name, vinerow_asset_##name##_end - vinerow_asset_##name)

VINEROW_ASSET(replay_style);
VINEROW_ASSET(replay_markup);
VINEROW_ASSET(replay_data);
VINEROW_ASSET(replay_look);
VINEROW_ASSET(replay_scene);
VINEROW_ASSET(replay_camera);
VINEROW_ASSET(replay_player);
VINEROW_ASSET(replay_controls);
VINEROW_ASSET(three_notice);
#ifdef VINEROW_HAS_THREE
VINEROW_ASSET(three);
VINEROW_ASSET(three_orbit_controls);
VINEROW_ASSET(three_gltf_loader);
VINEROW_ASSET(three_line_geometry);
VINEROW_ASSET(three_line_material);
VINEROW_ASSET(three_line_segments);
#endif

namespace vinerow::tools {

std::vector<std::string_view> three_scripts() {
#ifdef VINEROW_HAS_THREE
  return {VINEROW_ASSET_TEXT(three),
          VINEROW_ASSET_TEXT(three_orbit_controls),
          VINEROW_ASSET_TEXT(three_gltf_loader),
          VINEROW_ASSET_TEXT(three_line_geometry),
          VINEROW_ASSET_TEXT(three_line_material),
          VINEROW_ASSET_TEXT(three_line_segments)};
#else
  return {};
#endif
}

std::string_view three_notice() {
  return VINEROW_ASSET_TEXT(three_notice);
}
std::string_view replay_style() {
  return VINEROW_ASSET_TEXT(replay_style);
}
std::string_view replay_markup() {
  return VINEROW_ASSET_TEXT(replay_markup);
}

std::vector<std::string_view> replay_scripts() {
  return {VINEROW_ASSET_TEXT(replay_data),   VINEROW_ASSET_TEXT(replay_look),
          VINEROW_ASSET_TEXT(replay_scene),  VINEROW_ASSET_TEXT(replay_camera),
          VINEROW_ASSET_TEXT(replay_player), VINEROW_ASSET_TEXT(replay_controls)};
}

}  // namespace vinerow::tools
