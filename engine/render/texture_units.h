#pragma once
/// Texture units of the shaders' samplers.

namespace vinerow::render {

enum TextureUnit : int {
  kUnitShadow = 0,
  kUnitSky = 1,
  kUnitNoise = 2,
  kUnitGround = 3,
  kUnitMask = 4,
  kUnitLeaves = 5,
  kUnitImage = 6,
  kUnitGrid = 7,
  kUnitLand = 8,
  kUnitFields = 9,
  kUnitDepth = 10,
  kUnitAlbedo = 11,
  kUnitNormal = 12,
  kUnitGroundSeen = 13,
  kUnitSkySeen = 14,
};

struct SamplerUnit {
  const char* name;
  int unit;
};

inline constexpr SamplerUnit kSamplerUnits[] = {
    {"shadow_maps", kUnitShadow},  {"sky_table", kUnitSky},          {"noise_tile", kUnitNoise},
    {"ground_tile", kUnitGround},  {"row_mask", kUnitMask},          {"leaf_cards", kUnitLeaves},
    {"image", kUnitImage},         {"grid_cells", kUnitGrid},        {"land_tile", kUnitLand},
    {"field_table", kUnitFields},  {"frame_depth", kUnitDepth},      {"frame_albedo", kUnitAlbedo},
    {"frame_normal", kUnitNormal}, {"ground_seen", kUnitGroundSeen}, {"sky_seen", kUnitSkySeen},
};

}  // namespace vinerow::render
