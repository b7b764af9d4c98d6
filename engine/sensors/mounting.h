#pragma once
/// Mounting of a sensor on its vehicle: its parameters and its pose.

#include <Eigen/Core>

#include "engine/api/parameter_table_fwd.h"
#include "engine/math/pose.h"

namespace vinerow::sensors {

struct MountingParams {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();    ///< in B
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();  ///< roll, pitch, yaw of S in B

  Pose X_BS() const;
};

/// `position_m` [x, y, z] in B and `rotation_deg` [roll, pitch, yaw] of S in B (x of S is the
/// viewing direction).
const ParameterTable<MountingParams>& mounting_table();

}  // namespace vinerow::sensors
