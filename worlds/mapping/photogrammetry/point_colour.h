#pragma once
/// What colour a point of a world's surface has in a picture taken by daylight.
///
/// Plants, posts and obstacles have the mean of their mesh's vertex colours times the material's;
/// textures are not looked up. Ground is a mixture of grass and soil in patches of one metre and
/// less. Light is the sun's on a matt surface and an even sky; nothing casts a shadow.

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

  /// @param hit  with the normal towards who looks @param p_W  where it is
  /// @param grain  in [0, 1): the pixel's own brightness
  /// @returns sRGB. No heap, thread safe.
  std::array<std::uint8_t, 3> of(const RayHit& hit, const Eigen::Vector3d& p_W, double grain) const;
  /// Of weeds on the ground, likewise.
  std::array<std::uint8_t, 3> of_weed(double grain) const;

 private:
  std::array<std::uint8_t, 3> lit(const Eigen::Vector3f& colour, const Eigen::Vector3d& normal_W,
                                  double grain) const;

  std::vector<Eigen::Vector3f> mesh_colours_;  ///< linear, by index of WorldModel::meshes
  Eigen::Vector3d to_sun_W_;
  std::vector<std::uint8_t> encoded_;  ///< sRGB of linear values k / (size - 1)
};

}  // namespace vinerow::mapping
