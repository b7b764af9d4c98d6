#pragma once
/// Generator of a heading that a fixed-wing vehicle can follow: a coordinated turn with limits on
/// bank and bank rate, and lags.
///
/// Source: reference of paper A, section 2: phi_c = sat(atan(V k dpsi / g), phi_max), rate limit,
/// lag, psi' = g tan(phi) / V, here with a lag of the turn behind the bank as well: a vehicle that
/// rolls slips first, and its nose follows when its fins turn it into the wind. Angles here are
/// positive to the left, the bank too (left wing down). All functions are odd in the sign of the
/// turn, so that mirrored flights are mirrored to the bit.

#include <Eigen/Core>

#include "engine/math/angles.h"

namespace vinerow::controllers {

struct TurnLimits {
  double gain_per_s = 1.0;  ///< k
  double bank_rad = 0.0;    ///< phi_max, > 0
  double bank_rate_radps = rad_from_deg(60.0);
  double bank_lag_s = 0.3;
  double yaw_lag_s = 0.3;  ///< 0: no lag
  double gravity_mps2 = 9.80665;

  /// Of the turn at full bank.
  double radius_m(double airspeed_mps) const;
  double rate_radps(double airspeed_mps) const;
};

class HeadingGenerator {
 public:
  HeadingGenerator() = default;
  explicit HeadingGenerator(const TurnLimits& limits) : limits_(limits) {}

  void start(double heading_rad, double bank_left_rad = 0.0);
  /// @param wanted_rad  heading, not wrapped: the turn has the full difference
  /// @param wanted_rate_radps  of the wanted heading, fed forward
  void advance(double dt_s, double wanted_rad, double wanted_rate_radps, double airspeed_mps);

  double heading_rad() const { return heading_rad_; }  ///< continuous
  double rate_radps() const { return rate_radps_; }
  double bank_left_rad() const { return bank_rad_; }
  const TurnLimits& limits() const { return limits_; }

 private:
  TurnLimits limits_;
  double heading_rad_ = 0.0;
  double rate_radps_ = 0.0;
  double rate_limited_rad_ = 0.0;  // bank after the rate limit, before the lag
  double bank_rad_ = 0.0;
};

struct PredictedTurn {
  Eigen::Vector2d near_end = Eigen::Vector2d::Zero();  ///< where end_rad remains to turn
  Eigen::Vector2d at_rest = Eigen::Vector2d::Zero();   ///< where it flies straight again
};

/// Simulates a turn in mean wind, in plan view. No heap, at most some hundred short steps.
PredictedTurn predict_turn(HeadingGenerator generator, const Eigen::Vector2d& position,
                           double wanted_rad, double end_rad, const Eigen::Vector2d& wind,
                           double airspeed_mps);

}  // namespace vinerow::controllers
