#include "tools/replay/replay_assets.h"

VINEROW_ASSET(replay_style);
VINEROW_ASSET(replay_markup);
VINEROW_ASSET(replay_data);
VINEROW_ASSET(replay_look);
VINEROW_ASSET(replay_scene);
VINEROW_ASSET(replay_camera);
VINEROW_ASSET(replay_view);
VINEROW_ASSET(replay_view_controls);
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

std::vector<EmbeddedFile> three_scripts() {
#ifdef VINEROW_HAS_THREE
  return {{"three.min.js", VINEROW_ASSET_TEXT(three)},
          {"OrbitControls.js", VINEROW_ASSET_TEXT(three_orbit_controls)},
          {"GLTFLoader.js", VINEROW_ASSET_TEXT(three_gltf_loader)},
          {"LineSegmentsGeometry.js", VINEROW_ASSET_TEXT(three_line_geometry)},
          {"LineMaterial.js", VINEROW_ASSET_TEXT(three_line_material)},
          {"LineSegments2.js", VINEROW_ASSET_TEXT(three_line_segments)}};
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

std::vector<EmbeddedFile> picture_scripts() {
  return {{"data.js", VINEROW_ASSET_TEXT(replay_data)},
          {"look.js", VINEROW_ASSET_TEXT(replay_look)},
          {"scene.js", VINEROW_ASSET_TEXT(replay_scene)},
          {"camera.js", VINEROW_ASSET_TEXT(replay_camera)},
          {"view.js", VINEROW_ASSET_TEXT(replay_view)},
          {"view_controls.js", VINEROW_ASSET_TEXT(replay_view_controls)}};
}

std::vector<EmbeddedFile> player_scripts() {
  return {{"player.js", VINEROW_ASSET_TEXT(replay_player)},
          {"controls.js", VINEROW_ASSET_TEXT(replay_controls)}};
}

}  // namespace vinerow::tools
