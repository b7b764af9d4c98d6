#pragma once
/// Turn on the spot, from rest to rest: a polynomial of the fifth degree in time.

#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::controllers {

struct YawMove {
  double start_s = 0.0;
  double duration_s = 0.0;
  double from_rad = 0.0;
  double turn_rad = 0.0;

  double end_rad() const { return from_rad + turn_rad; }
  double end_s() const { return start_s + duration_s; }

  struct Sample {
    double yaw_rad, rate_radps;
  };
  Sample at(double time_s) const {
    if (duration_s <= 0.0) return {end_rad(), 0.0};
    const double x = std::clamp((time_s - start_s) / duration_s, 0.0, 1.0);
    const double share = x * x * x * (10.0 + x * (6.0 * x - 15.0));
    const double slope = 30.0 * x * x * (1.0 - x) * (1.0 - x);
    return {from_rad + share * turn_rad, slope * turn_rad / duration_s};
  }
};

/// The shorter turn to a heading, as fast as both limits allow: the polynomial's rate is at most
/// 15/8 turn / duration, its acceleration at most 10/sqrt(3) turn / duration^2.
inline YawMove make_yaw_move(double start_s, double from_rad, double to_rad, double rate_radps,
                             double acceleration_radps2) {
  const double turn_rad = wrap_angle(to_rad - from_rad);
  const double size_rad = std::abs(turn_rad);
  const double duration_s =
      std::max(1.875 * size_rad / rate_radps,
               std::sqrt(10.0 / std::sqrt(3.0) * size_rad / acceleration_radps2));
  return {start_s, duration_s, from_rad, turn_rad};
}

}  // namespace vinerow::controllers
