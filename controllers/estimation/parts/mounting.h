#pragma once
/// Where the sensors of an estimator are mounted.

#include <Eigen/Core>
#include <optional>
#include <string>

#include "engine/api/stepped_parts.h"
#include "engine/math/pose.h"

namespace vinerow::controllers {

/// X_BS of a sensor by name; the identity if no such sensor has a mounting.
Pose mounting_of(const EstimatorContext& context, const std::string& sensor);

/// Antenna of a satellite receiver in B, m: as given, else where the receiver is mounted.
Eigen::Vector3d antenna_of(const EstimatorContext& context, const std::string& receiver,
                           const std::optional<Eigen::Vector3d>& given_B);

}  // namespace vinerow::controllers
