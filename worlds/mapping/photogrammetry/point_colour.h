#pragma once
/// Colour of a point of a world's surface in a picture taken in daylight.
///
/// Plants, posts and obstacles have the mean of their mesh's vertex colours times the material's;
/// textures are ignored. Ground is a mixture of grass and soil in patches of one metre and less.
/// Light is the sun on a matt surface and a uniform sky; there are no shadows.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"

namespace vinerow::mapping {

class PointColour {
 public:
  explicit PointColour(const WorldModel& world);

  /// @param hit  with the normal towards the viewer @param p_W  its position
  /// @param grain  in [0, 1): brightness of the pixel
  /// @returns sRGB. No heap, thread safe.
  std::array<std::uint8_t, 3> of(const RayHit& hit, const Eigen::Vector3d& p_W, double grain) const;
  /// Colour of weeds on the ground, likewise.
  std::array<std::uint8_t, 3> of_weed(double grain) const;

 private:
  std::array<std::uint8_t, 3> lit(const Eigen::Vector3f& colour, const Eigen::Vector3d& normal_W,
                                  double grain) const;

  std::vector<Eigen::Vector3f> mesh_colours_;  ///< linear, by index of WorldModel::meshes
  Eigen::Vector3d to_sun_W_;
  std::vector<std::uint8_t> encoded_;  ///< sRGB of linear values k / (size - 1)
};

}  // namespace vinerow::mapping
