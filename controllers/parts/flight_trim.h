#pragma once
/// Steady flight of a vehicle on wings: straight, climbing, or in a coordinated turn.

#include <string>

#include "controllers/parts/aircraft.h"
#include "engine/core/result.h"

namespace vinerow {

struct TrimRequest {
  double airspeed_mps = 12.0;
  double climb_angle_rad = 0.0;  ///< of the path through the air
  double bank_rad = 0.0;         ///< phi, positive with the right wing down; turn rate follows
};

/// All in the signs of aviation, see aircraft.h.
struct Trim {
  TrimRequest request;
  AircraftControls controls;
  double alpha_rad = 0.0, beta_rad = 0.0;
  double roll_rad = 0.0, pitch_rad = 0.0;
  double u_mps = 0.0, v_mps = 0.0, w_mps = 0.0;
  double p_radps = 0.0, q_radps = 0.0, r_radps = 0.0;
  double turn_rate_radps = 0.0;  ///< of psi, clockwise
  double load_factor = 1.0;      ///< lift over weight
  double residual = 0.0;         ///< largest acceleration left, m/s2 or rad/s2
  int iterations = 0;
};

/// Newton's method with central differences: no acceleration, no angular acceleration, no side
/// slip force beyond that of the turn (v from the equations; coordinated: lateral specific force
/// 0).
/// @returns a failure in one sentence where there is none: stall, throttle or elevons out of range,
/// with the numbers: "no steady flight at 7.0 m/s, climb 0 deg, bank 0 deg: it takes a lift
/// coefficient of ... / throttle 1.31 of at most 1 ..."
Result<Trim> find_trim(const Aircraft& aircraft, const TrimRequest& request);

}  // namespace vinerow
