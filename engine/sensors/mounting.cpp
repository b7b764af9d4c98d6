#include "engine/sensors/mounting.h"

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/sensors/readings.h"

namespace vinerow {

std::vector<ParameterSpec> mounting_parameters(Eigen::Vector3d default_position_m) {
  return {number_list_parameter(
              "position_m", "m",
              {default_position_m.x(), default_position_m.y(), default_position_m.z()},
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

ParameterSpec delay_parameter() {
  return number_parameter("delay_s", "s", 0.0, 0.0, 10.0,
                          "time between measurement and delivery, a multiple of the physics step");
}

Duration delay_of(const ParameterSet& parameters) {
  return duration_from_s(parameters.number("delay_s"));
}

ParameterSpec outage_parameter() {
  return group_list_parameter(
      "outages",
      {required(number_parameter("begin_s", "s", 0.0, 0.0, 1e7, "start of the outage")),
       required(number_parameter("end_s", "s", 0.0, 0.0, 1e7, "end of the outage"))},
      "time windows without a reading");
}

std::vector<ParameterSpec> reading_parameters() {
  return {delay_parameter(),
          number_parameter("dropout_share", "", 0.0, 0.0, 1.0,
                           "share of the readings that never arrive, drawn one by one"),
          outage_parameter()};
}

std::vector<Outage> outages_of(const ParameterSet& parameters) {
  std::vector<Outage> outages;
  for (const ParameterSet& window : parameters.groups("outages")) {
    const double begin_s = window.number("begin_s"), end_s = window.number("end_s");
    if (end_s < begin_s) {
      throw ConfigError(
          fmt::format("outages: end_s = {} s, must be >= begin_s = {} s", end_s, begin_s));
    }
    outages.push_back({Time{duration_from_s(begin_s).ns}, Time{duration_from_s(end_s).ns}});
  }
  return outages;
}

bool is_in_outage(const std::vector<Outage>& outages, Time now) {
  for (const Outage& outage : outages) {
    if (now >= outage.begin && now < outage.end) return true;
  }
  return false;
}

}  // namespace vinerow
