#pragma once
/// A cone as a bundle of rays, each standing for a share of the cone's solid angle.

#include <Eigen/Core>
#include <vector>

namespace vinerow::sensors {

struct ConeRay {
  Eigen::Vector3d dir_S = Eigen::Vector3d::UnitX();  ///< unit; x of S is the axis
  double off_axis_rad = 0.0;
  double share = 1.0;  ///< of the cone's solid angle; all together 1
};

/// The axis, then rings of 6, 12, 18 ... rays at equal angular spacing; the last lies on the rim.
/// Inner rings are turned, so that few rays lie above one another and a slim post is met by some.
/// The rim is not: where `rings` is even, it has a ray to each side, one straight up and one down,
/// which are the nearest to a wall or to the ground.
/// @param half_angle_rad  in [0, pi/2); 0 gives one ray, as `rings` = 0 does
std::vector<ConeRay> cone_rays(double half_angle_rad, int rings);

}  // namespace vinerow::sensors
