#include "controllers/parts/aircraft/aircraft_ranges.h"

#include "engine/api/parameter_table.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

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

const ParameterTable<AircraftRanges>& aircraft_range_table() {
  using R = AircraftRanges;
  const auto lon = [](int i) { return [i](R& r) -> double& { return r.lon[i]; }; };
  const auto lat = [](int i) { return [i](R& r) -> double& { return r.lat[i]; }; };
  static const ParameterTable<R> table =
      ParameterTable<R>()
          .number("u_mps", "m/s", lon(0), kPositive, "forward speed")
          .number("w_mps", "m/s", lon(1), kPositive, "speed across the wings")
          .number("q_degps", "deg/s", lon(2), kPositive, "pitch rate", kDegrees)
          .degrees("theta_deg", lon(3), kPositive, "pitch")
          .number("h_m", "m", lon(4), kPositive, "height")
          .number("throttle", "", &R::throttle, kPositive, "throttle")
          .degrees("elevator_deg", &R::elevator_rad, kPositive, "elevator")
          .number("v_mps", "m/s", lat(0), kPositive, "side speed")
          .number("p_degps", "deg/s", lat(1), kPositive, "roll rate", kDegrees)
          .number("r_degps", "deg/s", lat(2), kPositive, "yaw rate", kDegrees)
          .degrees("phi_deg", lat(3), kPositive, "roll")
          .degrees("psi_deg", lat(4), kPositive, "heading")
          .degrees("aileron_deg", &R::aileron_rad, kPositive, "aileron");
  return table;
}

}  // namespace vinerow::controllers
