#pragma once
/// Kinematics of a vehicle with two steered axles: crab and curve at once.
///
/// With k and s of engine/math/axle_roll.h the velocity of the centre is v_x (1, s) and the yaw
/// rate k v_x. Per metre that the centre travels it turns by k / sqrt(1 + s^2), in the direction
/// atan(s) off the nose.

#include <algorithm>
#include <cmath>

#include "controllers/parts/paths/pose2.h"
#include "engine/api/vehicle_kinds.h"
#include "engine/math/axle_roll.h"

namespace vinerow::controllers {

struct RollingMotion {
  double course_rad = 0.0;       ///< direction of travel of the centre from the nose
  double curvature_per_m = 0.0;  ///< heading change per metre that the centre travels
};

inline RollingMotion calc_motion(const AxleAngles& steering, const SteeredVehicle& geometry) {
  const AxleRoll roll = calc_axle_roll(geometry.front_axle_m, geometry.rear_axle_m, steering);
  return {std::atan(roll.drift), roll.curvature_per_m / std::sqrt(1.0 + roll.drift * roll.drift)};
}

/// Exact pose after the centre has travelled `length_m` (negative: backwards), steering constant.
inline Pose2 roll(const Pose2& pose, const RollingMotion& motion, double length_m) {
  const Pose2 moved = advance({pose.p, pose.yaw_rad + motion.course_rad}, length_m,
                              length_m * motion.curvature_per_m);
  return {moved.p, moved.yaw_rad - motion.course_rad};
}

/// Moves both axles towards their targets, each by at most `max_rad`.
inline AxleAngles turn_axles(const AxleAngles& now, const AxleAngles& target, double max_rad) {
  return {now.front_rad + std::clamp(target.front_rad - now.front_rad, -max_rad, max_rad),
          now.rear_rad + std::clamp(target.rear_rad - now.rear_rad, -max_rad, max_rad)};
}

}  // namespace vinerow::controllers
