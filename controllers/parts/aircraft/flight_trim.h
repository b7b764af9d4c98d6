#pragma once
/// Trim of a fixed-wing vehicle: steady flight that is straight, climbing or a coordinated turn.

#include <string>

#include "controllers/parts/aircraft/aircraft.h"
#include "engine/core/result.h"

namespace vinerow::controllers {

struct TrimRequest {
  double airspeed_mps = 12.0;
  double climb_angle_rad = 0.0;  ///< of the path through the air
  /// Of the coordinated turn, right wing down > 0. It sets the turn rate, g tan(bank) / airspeed.
  double bank_rad = 0.0;
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

/// Newton's method with central differences on the equations of six degrees of freedom: no
/// acceleration, no angular acceleration, climb angle and turn rate as requested. Side slip and
/// roll are results: without a rudder a turn slips a little, and roll differs from the coordinated
/// turn's by up to about 2 deg.
/// @returns a failure in one sentence if no trim exists (stall, throttle or elevons out of range),
/// with the numbers and the speeds at which one exists: "no steady flight at 7.00 m/s, climb 0.0
/// deg, bank 0.0 deg: it takes 11.8 N of lift and the wings give at most 8.3 N at 17.3 deg of
/// incidence; it can fly so from 8.40 to 24.10 m/s"
Result<Trim> find_trim(const Aircraft& aircraft, const TrimRequest& request);

/// Steady flight with a given throttle. The search starts at the climb angle of `request`; that of
/// the result follows from the throttle.
/// @returns a failure in one sentence
Result<Trim> find_trim_at_throttle(const Aircraft& aircraft, const TrimRequest& request,
                                   double throttle);

/// Range of speeds at which steady flight exists, to 1 mm/s.
struct SpeedRange {
  double slowest_mps = 0.0, fastest_mps = 0.0;
};
/// @returns a failure if none exists between a fifth and five times the cruise speed
Result<SpeedRange> find_speed_range(const Aircraft& aircraft, double climb_angle_rad,
                                    double bank_rad);

}  // namespace vinerow::controllers
