#include "controllers/parts/aircraft_ranges.h"

#include <utility>

#include "engine/math/angles.h"

namespace vinerow {

AircraftRanges AircraftRangesInDeg::to_si() const {
  AircraftRanges ranges;
  ranges.lon << u_mps, w_mps, rad_from_deg(q_degps), rad_from_deg(theta_deg), h_m;
  ranges.lat << v_mps, rad_from_deg(p_degps), rad_from_deg(r_degps), rad_from_deg(phi_deg),
      rad_from_deg(psi_deg);
  ranges.throttle = throttle;
  ranges.elevator_rad = rad_from_deg(elevator_deg);
  ranges.aileron_rad = rad_from_deg(aileron_deg);
  return ranges;
}

ParameterSpec aircraft_range_parameter(std::string name, const AircraftRangesInDeg& defaults,
                                       std::string description) {
  return group_parameter(
      std::move(name),
      {
          positive_parameter("u_mps", "m/s", defaults.u_mps, "forward speed"),
          positive_parameter("w_mps", "m/s", defaults.w_mps, "speed across the wings"),
          positive_parameter("q_degps", "deg/s", defaults.q_degps, "pitch rate"),
          positive_parameter("theta_deg", "deg", defaults.theta_deg, "pitch"),
          positive_parameter("h_m", "m", defaults.h_m, "height"),
          positive_parameter("throttle", "", defaults.throttle, "throttle"),
          positive_parameter("elevator_deg", "deg", defaults.elevator_deg, "elevator"),
          positive_parameter("v_mps", "m/s", defaults.v_mps, "side speed"),
          positive_parameter("p_degps", "deg/s", defaults.p_degps, "roll rate"),
          positive_parameter("r_degps", "deg/s", defaults.r_degps, "yaw rate"),
          positive_parameter("phi_deg", "deg", defaults.phi_deg, "roll"),
          positive_parameter("psi_deg", "deg", defaults.psi_deg, "heading"),
          positive_parameter("aileron_deg", "deg", defaults.aileron_deg, "aileron"),
      },
      std::move(description));
}

AircraftRanges read_aircraft_ranges(const ParameterSet& parameters, const std::string& name,
                                    const AircraftRangesInDeg& defaults) {
  if (!parameters.has(name)) return defaults.to_si();
  const ParameterSet& group = parameters.group(name);
  const auto number = [&](const char* key) { return group.number(key); };
  return AircraftRangesInDeg{number("u_mps"),        number("w_mps"),   number("q_degps"),
                             number("theta_deg"),    number("h_m"),     number("throttle"),
                             number("elevator_deg"), number("v_mps"),   number("p_degps"),
                             number("r_degps"),      number("phi_deg"), number("psi_deg"),
                             number("aileron_deg")}
      .to_si();
}

}  // namespace vinerow
