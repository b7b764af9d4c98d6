#pragma once
/// Where a sensor sits on its vehicle: the parameters every sensor has, and the pose they make.

#include <vector>

#include "engine/api/parameters.h"
#include "engine/core/time.h"
#include "engine/math/pose.h"

namespace vinerow {

/// `position_m` [x, y, z] in B and `rotation_deg` [roll, pitch, yaw] of S in B (x of S is where the
/// sensor looks).
std::vector<ParameterSpec> mounting_parameters(Eigen::Vector3d default_position_m);

/// X_BS of the mounting parameters.
Pose mounting_pose(const ParameterSet& parameters);

/// `delay_s` as a Duration. It must be a multiple of the physics step, which the scheduler checks.
ParameterSpec delay_parameter();
Duration delay_of(const ParameterSet& parameters);

/// A time window in which a sensor says nothing (or something bad).
struct Outage {
  Time begin;
  Time end;
};
ParameterSpec outage_parameter();
/// @throws ConfigError if a window ends before it begins
std::vector<Outage> outages_of(const ParameterSet& parameters);
/// True if `now` lies in a window [begin, end).
bool is_in_outage(const std::vector<Outage>& outages, Time now);

}  // namespace vinerow
