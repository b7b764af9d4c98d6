#pragma once
/// Where a sensor sits on its vehicle: the parameters every sensor has, and the pose they make.

#include <vector>

#include "engine/api/parameters.h"
#include "engine/math/pose.h"

namespace vinerow {

/// `position_m` [x, y, z] in B and `rotation_deg` [roll, pitch, yaw] of S in B (x of S is where the
/// sensor looks).
std::vector<ParameterSpec> mounting_parameters();

/// X_BS of the mounting parameters.
Pose mounting_pose(const ParameterSet& parameters);

}  // namespace vinerow
