#pragma once
/// Where a sensor sits on its vehicle: the parameters every sensor has, and the pose they make.

#include <Eigen/Core>

#include "engine/api/parameter_table_fwd.h"
#include "engine/math/pose.h"

namespace vinerow::sensors {

struct MountingParams {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();    ///< in B
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();  ///< roll, pitch, yaw of S in B

  Pose X_BS() const;
};

/// `position_m` [x, y, z] in B and `rotation_deg` [roll, pitch, yaw] of S in B (x of S is where the
/// sensor looks).
const ParameterTable<MountingParams>& mounting_table();

}  // namespace vinerow::sensors
