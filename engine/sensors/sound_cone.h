#pragma once
/// Cone as a bundle of rays, each with a share of the cone's solid angle.

#include <Eigen/Core>
#include <vector>

namespace vinerow::sensors {

struct ConeRay {
  Eigen::Vector3d dir_S = Eigen::Vector3d::UnitX();  ///< unit; x of S is the axis
  double off_axis_rad = 0.0;
  double share = 1.0;  ///< of the cone's solid angle; the sum is 1
};

/// The axis, then rings of 6, 12, 18 ... rays at equal angular spacing; the last ring is on the
/// rim. Inner rings are rotated, so that few rays are above one another and some hit a slim post.
/// The rim is not rotated: if `rings` is even, it has a ray to each side, one straight up and one
/// down, which are the nearest to a wall or to the ground.
/// @param half_angle_rad  in [0, pi/2); 0 gives one ray, as `rings` = 0 does
std::vector<ConeRay> cone_rays(double half_angle_rad, int rings);

}  // namespace vinerow::sensors
