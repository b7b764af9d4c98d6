#include "controllers/waypoint_guidance/heading_generator.h"

#include <algorithm>
#include <cmath>

#include "controllers/parts/aircraft/wind_triangle.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

double TurnLimits::radius_m(double airspeed_mps) const {
  return airspeed_mps * airspeed_mps / (gravity_mps2 * std::tan(bank_rad));
}

double TurnLimits::rate_radps(double airspeed_mps) const {
  return gravity_mps2 * std::tan(bank_rad) / airspeed_mps;
}

void HeadingGenerator::start(double heading_rad, double bank_left_rad) {
  heading_rad_ = heading_rad;
  bank_rad_ = rate_limited_rad_ = std::clamp(bank_left_rad, -limits_.bank_rad, limits_.bank_rad);
  rate_radps_ = 0.0;
}

void HeadingGenerator::advance(double dt_s, double wanted_rad, double wanted_rate_radps,
                               double airspeed_mps) {
  const double turn_radps = limits_.gain_per_s * (wanted_rad - heading_rad_) + wanted_rate_radps;
  const double bank_rad = std::clamp(std::atan(airspeed_mps * turn_radps / limits_.gravity_mps2),
                                     -limits_.bank_rad, limits_.bank_rad);
  const double max_rad = limits_.bank_rate_radps * dt_s;
  rate_limited_rad_ += std::clamp(bank_rad - rate_limited_rad_, -max_rad, max_rad);
  bank_rad_ += (rate_limited_rad_ - bank_rad_) * (1.0 - std::exp(-dt_s / limits_.bank_lag_s));
  const double before_radps = rate_radps_;
  const double steady_radps = limits_.gravity_mps2 * std::tan(bank_rad_) / airspeed_mps;
  // Without a lag the exponent is minus infinity and the exponential zero.
  rate_radps_ += (steady_radps - rate_radps_) * (1.0 - std::exp(-dt_s / limits_.yaw_lag_s));
  heading_rad_ += 0.5 * dt_s * (before_radps + rate_radps_);
}

PredictedTurn predict_turn(HeadingGenerator generator, const Eigen::Vector2d& position,
                           double wanted_rad, double end_rad, const Eigen::Vector2d& wind,
                           double airspeed_mps) {
  constexpr double kStep_s = 0.05;
  constexpr double kStraight_rad = 0.5 * kPi / 180.0;
  PredictedTurn turn{position, position};
  // Two full turns at full bank and the time to come to rest: an upper bound.
  const double longest_s = 4.0 * kPi / generator.limits().rate_radps(airspeed_mps) + 20.0;
  // Turns at the smallest bank take less.
  constexpr double kMaxSteps = 1e5;
  const int steps = static_cast<int>(std::min(longest_s / kStep_s, kMaxSteps));
  for (int i = 0; i < steps; ++i) {
    const double left_rad = std::abs(wanted_rad - generator.heading_rad());
    if (left_rad < kStraight_rad && std::abs(generator.bank_left_rad()) < 4.0 * kStraight_rad) {
      break;
    }
    const double before_rad = generator.heading_rad();
    generator.advance(kStep_s, wanted_rad, 0.0, airspeed_mps);
    const double mean_rad = 0.5 * (before_rad + generator.heading_rad());
    turn.at_rest += kStep_s * calc_ground_velocity(mean_rad, wind, airspeed_mps);
    if (left_rad > end_rad) turn.near_end = turn.at_rest;
  }
  return turn;
}

}  // namespace vinerow::controllers
