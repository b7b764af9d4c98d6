#pragma once
/// Usual autopilot of a fixed-wing vehicle about the reference's steady flight, which is fed
/// forward:
///   height -> climb rate -> pitch -> elevator, pitch rate damped
///   airspeed -> throttle
///   heading -> bank -> aileron, roll and yaw rate damped
/// Source of the structure: Beard, McLain, "Small unmanned aircraft", 2012, ch. 6 (successive loop
/// closure), here without rudder. Gains are chosen for an aircraft of about 1 kg and 12 m/s.

#include "controllers/parts/aircraft/aircraft_ports.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

struct FixedWingGains {
  double height_per_s = 0.6;         ///< climb rate wanted per height error
  double climb_limit_mps = 2.5;      ///< largest such climb rate
  double climb_rad_per_mps = 0.075;  ///< pitch per climb rate error
  double climb_integral_rad_per_m = 0.02;
  double pitch_limit_rad = rad_from_deg(15.0);     ///< largest pitch wanted, from the trim's
  double incidence_limit_rad = rad_from_deg(6.0);  ///< largest angle of attack, likewise
  double pitch = 0.9;                              ///< elevator per pitch error
  double pitch_rate_s = 0.06;                      ///< elevator per pitch rate
  double airspeed_per_mps = 0.10;                  ///< throttle per airspeed error
  double airspeed_integral_per_m = 0.02;
  double heading = 1.0;                        ///< bank per heading error
  double bank_limit_rad = rad_from_deg(35.0);  ///< largest bank wanted, from the trim's
  double bank = 0.55;                          ///< aileron per bank error
  double bank_integral_per_s = 0.1;
  double roll_rate_s = 0.045;  ///< aileron per roll rate
  double yaw_rate_s = 0.12;    ///< aileron per yaw rate, against the dutch roll
};

class FixedWingPidLaw {
 public:
  FixedWingPidLaw(const FixedWingGains& gains, double airspeed_mps, double period_s)
      : gains_(gains), airspeed_mps_(airspeed_mps), period_s_(period_s) {}

  /// Sets the integrators to zero.
  void reset();
  /// One cycle. No heap. @param x  deviation from steady flight
  /// @param climb_mps  climb rate beyond the reference's
  /// @returns deviations of the controls from the trim's
  AircraftControls step(const AircraftDeviation& x, double climb_mps);
  /// Updates the integrators. They stop while an actuator is at its limit or the propeller is off.
  /// @param requested  the last step()  @param left  its part that the actuators reach
  void learn(const AircraftControls& requested, const AircraftControls& left);

 private:
  FixedWingGains gains_;
  double airspeed_mps_, period_s_;
  bool is_near_stall_ = false;
  double climb_error_mps_ = 0.0, airspeed_error_mps_ = 0.0, bank_error_rad_ = 0.0;
  double pitch_learnt_rad_ = 0.0, throttle_learnt_ = 0.0, aileron_learnt_rad_ = 0.0;
};

}  // namespace vinerow::controllers
