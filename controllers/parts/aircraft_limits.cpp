#include "controllers/parts/aircraft_limits.h"

#include "engine/math/angles.h"

namespace vinerow {
namespace {

constexpr double kElevator_deg = 10.0, kAileron_deg = 12.0;
constexpr double kQ_degps = 150.0, kTheta_deg = 20.0;
constexpr double kP_degps = 250.0, kR_degps = 120.0, kPhi_deg = 45.0, kPsi_deg = 30.0;

}  // namespace

AircraftLimits::AircraftLimits()
    : elevator_rad(rad_from_deg(kElevator_deg)), aileron_rad(rad_from_deg(kAileron_deg)) {
  lon << 2.4, 3.0, rad_from_deg(kQ_degps), rad_from_deg(kTheta_deg), 15.0;
  lat << 5.0, rad_from_deg(kP_degps), rad_from_deg(kR_degps), rad_from_deg(kPhi_deg),
      rad_from_deg(kPsi_deg);
}

ParameterSpec aircraft_limit_parameter() {
  const AircraftLimits limits;
  return group_parameter(
      "limits",
      {
          positive_parameter("u_mps", "m/s", limits.lon(0), "forward speed"),
          positive_parameter("w_mps", "m/s", limits.lon(1), "speed across the wings"),
          positive_parameter("q_degps", "deg/s", kQ_degps, "pitch rate"),
          positive_parameter("theta_deg", "deg", kTheta_deg, "pitch"),
          positive_parameter("h_m", "m", limits.lon(4), "height"),
          positive_parameter("throttle", "", limits.throttle, "throttle"),
          positive_parameter("elevator_deg", "deg", kElevator_deg, "elevator"),
          positive_parameter("v_mps", "m/s", limits.lat(0), "side speed"),
          positive_parameter("p_degps", "deg/s", kP_degps, "roll rate"),
          positive_parameter("r_degps", "deg/s", kR_degps, "yaw rate"),
          positive_parameter("phi_deg", "deg", kPhi_deg, "roll"),
          positive_parameter("psi_deg", "deg", kPsi_deg, "heading"),
          positive_parameter("aileron_deg", "deg", kAileron_deg, "aileron"),
      },
      "largest deviations from the reference's steady flight, to either side (paper A, section 2; "
      "defaults: the relaxed reading of its percentages)");
}

AircraftLimits read_aircraft_limits(const ParameterSet& parameters) {
  if (!parameters.has("limits")) return {};
  const ParameterSet& group = parameters.group("limits");
  const auto angle = [&](const char* name) { return rad_from_deg(group.number(name)); };
  AircraftLimits limits;
  limits.lon << group.number("u_mps"), group.number("w_mps"), angle("q_degps"), angle("theta_deg"),
      group.number("h_m");
  limits.lat << group.number("v_mps"), angle("p_degps"), angle("r_degps"), angle("phi_deg"),
      angle("psi_deg");
  limits.throttle = group.number("throttle");
  limits.elevator_rad = angle("elevator_deg");
  limits.aileron_rad = angle("aileron_deg");
  return limits;
}

}  // namespace vinerow
