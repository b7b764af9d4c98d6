#pragma once
/// Estimator `gps_pose`: the satellite fix is the position (paper B: noisy position, exact
/// heading).

#include <memory>

#include "engine/api/part.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

PartSpec gps_pose_spec();
std::unique_ptr<Estimator> make_gps_pose(const ParameterSet& parameters,
                                         const EstimatorContext& context);

}  // namespace vinerow::controllers
