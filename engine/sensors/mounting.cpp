#include "engine/sensors/mounting.h"

#include "engine/math/angles.h"

namespace vinerow {

std::vector<ParameterSpec> mounting_parameters() {
  return {
      number_list_parameter("position_m", "m", {0.0, 0.0, 0.0},
                            "place of the sensor in the body frame (x forward, y left, z up)", 3),
      number_list_parameter(
          "rotation_deg", "deg", {0.0, 0.0, 0.0},
          "roll, pitch, yaw of the sensor in the body frame; it looks along its x axis", 3)};
}

Pose mounting_pose(const ParameterSet& parameters) {
  const auto& p = parameters.numbers("position_m");
  const auto& rpy = parameters.numbers("rotation_deg");
  return {quaternion_from_rpy({rad_from_deg(rpy[0]), rad_from_deg(rpy[1]), rad_from_deg(rpy[2])}),
          Eigen::Vector3d(p[0], p[1], p[2])};
}

}  // namespace vinerow
