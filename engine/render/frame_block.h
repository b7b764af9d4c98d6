#pragma once
/// Uniform block of all shaders (see shaders::frame_block), in the std140 layout.

#include <Eigen/Core>

namespace vinerow::render {

struct FrameBlock {
  float clip_from_world[16];
  float world_from_clip[16];
  float near_from_world[16];
  float far_from_world[16];
  float eye[4];
  float forward[4];
  float sun_direction[4];
  float sun_irradiance[4];
  float sky_irradiance[4];
  float ground_irradiance[4];
  float haze_to_sun[4];
  float haze_from_sun[4];
  float mask_rect[4];
  float shadow_info[4];
  float land_rect[4];
  float soil_look[4];
  float grass_look[4];
  float sampling[4];
};

/// Stores values as column-major floats.
inline void store(float (&to)[16], const Eigen::Matrix4d& from) {
  for (int i = 0; i < 16; ++i) to[i] = static_cast<float>(from.data()[i]);
}
inline void store(float (&to)[4], const Eigen::Vector3d& from, double w = 0.0) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(from[i]);
  to[3] = static_cast<float>(w);
}

}  // namespace vinerow::render
