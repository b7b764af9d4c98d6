#pragma once
/// References for tests, as functions of time with consistent derivatives.

#include <functional>

#include "engine/api/messages/flight.h"
#include "tests/controllers/support/quadrotor_sim.h"

namespace vinerow::test {

using TimedPath = std::function<TrajectoryPoint(double time_s)>;

/// Stands at a place.
TimedPath stand_at(const Eigen::Vector3d& p_W, double yaw_rad = 0.0);
/// On a straight line at constant speed, forwards.
TimedPath straight(const Eigen::Vector3d& p_W, double yaw_rad, double speed_mps);

/// Two rows side by side and the omega turn between them (three arcs, curvature jumps), terrain
/// with slope and bumps: the case of section 5 of the reference page on paper A.
struct RowsAndTurn {
  TimedPath path;
  std::function<bool(double time_s)> is_row;  ///< at full speed on a straight
  std::function<bool(double time_s)> is_turn;
  double end_s = 0.0;
};
struct RowsAndTurnNumbers {
  double row_m = 60.0, spacing_m = 2.5, radius_m = 1.77;
  double row_mps = 3.0, turn_mps = 1.63, acceleration_mps2 = 1.0;
  double slope = 0.16;
  double bump_m = 0.15, bump_length_m = 19.0;  ///< amplitude and wavelength
  double yaw_rad = 0.0;                        ///< of the first row
};
RowsAndTurn make_rows_and_turn(const RowsAndTurnNumbers& numbers = {});

/// Wind of a mean across the first row, from its right, and gusts along all three axes: noise of
/// sigma gust / 2, correlated over correlation_s, cut at the gust. Made beforehand.
WindField gusty_side_wind(double mean_mps, double gust_mps, double correlation_s, double longest_s,
                          std::uint64_t seed);

}  // namespace vinerow::test
