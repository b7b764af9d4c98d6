#include "controllers/fixed_wing_pid/fixed_wing_pid_law.h"

#include <algorithm>
#include <cmath>

namespace vinerow::controllers {
namespace {

/// Differences of controls below this are rounding.
constexpr double kRounding = 1e-9;
/// Limits of the integrators: enough for asymmetry and a wrong model.
constexpr double kMaxPitch_rad = 0.1, kMaxThrottle = 0.2, kMaxAileron_rad = 0.05;

double within(double value, double limit) {
  return std::clamp(value, -limit, limit);
}

/// Integrates an error unless that would push a saturated actuator further.
void learn_from(double& learnt, double step, double max_learnt, bool is_stopped) {
  if (!is_stopped) learnt = within(learnt + step, max_learnt);
}

}  // namespace

void FixedWingPidLaw::reset() {
  climb_error_mps_ = airspeed_error_mps_ = bank_error_rad_ = 0.0;
  pitch_learnt_rad_ = throttle_learnt_ = aileron_learnt_rad_ = 0.0;
}

AircraftControls FixedWingPidLaw::step(const AircraftDeviation& x, double climb_mps) {
  const double u = x.lon(0), w = x.lon(1), q = x.lon(2), theta = x.lon(3), h = x.lon(4);
  const double p = x.lat(1), r = x.lat(2), phi = x.lat(3), psi = x.lat(4);
  climb_error_mps_ = within(-gains_.height_per_s * h, gains_.climb_limit_mps) - climb_mps;
  airspeed_error_mps_ = -u;
  const double wanted = within(gains_.climb_rad_per_mps * climb_error_mps_ + pitch_learnt_rad_,
                               gains_.pitch_limit_rad);
  // Limits the pitch to that of the largest angle of attack, which keeps clear of the stall.
  const double highest = theta + gains_.incidence_limit_rad - w / airspeed_mps_;
  const double pitch = std::min(wanted, highest);
  is_near_stall_ = wanted > highest;
  const double bank = within(-gains_.heading * psi, gains_.bank_limit_rad);
  bank_error_rad_ = bank - phi;
  // Elevator down lowers the nose, aileron > 0 rolls right.
  return {gains_.airspeed_per_mps * airspeed_error_mps_ + throttle_learnt_,
          gains_.pitch * (theta - pitch) + gains_.pitch_rate_s * q,
          gains_.bank * bank_error_rad_ + aileron_learnt_rad_ - gains_.roll_rate_s * p -
              gains_.yaw_rate_s * r};
}

void FixedWingPidLaw::learn(const AircraftControls& requested, const AircraftControls& left) {
  const auto stops = [](double wanted, double reached, double push) {
    const double cut = wanted - reached;
    return std::abs(cut) > kRounding && cut * push > 0.0;
  };
  const double climb = gains_.climb_integral_rad_per_m * period_s_ * climb_error_mps_;
  const double speed = gains_.airspeed_integral_per_m * period_s_ * airspeed_error_mps_;
  const double bank = gains_.bank_integral_per_s * period_s_ * bank_error_rad_;
  learn_from(
      pitch_learnt_rad_, climb, kMaxPitch_rad,
      stops(requested.elevator_rad, left.elevator_rad, -climb) || (is_near_stall_ && climb > 0));
  learn_from(throttle_learnt_, speed, kMaxThrottle,
             stops(requested.throttle, left.throttle, speed));
  learn_from(aileron_learnt_rad_, bank, kMaxAileron_rad,
             stops(requested.aileron_rad, left.aileron_rad, bank));
}

}  // namespace vinerow::controllers
