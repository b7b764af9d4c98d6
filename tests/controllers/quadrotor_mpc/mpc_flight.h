#pragma once
/// Flights of controller quadrotor_mpc: its loop, references with consistent derivatives, and how
/// far off them it flies.

#include <functional>

#include "tests/controllers/support/quadrotor_loop.h"

namespace vinerow::test {

/// The loop ticks with the controller and starts in hover where the path begins, with its speed.
struct MpcSetup : QuadrotorSetup {
  MpcSetup() {
    controller.type = "quadrotor_mpc";
    tick = {};
    starts_on_path = true;
  }
};

/// On a straight line at constant speed, forwards.
FlightPath straight(const Eigen::Vector3d& p_W, double yaw_rad, double speed_mps);

/// Two rows side by side and the omega turn between them (three arcs, curvature jumps), terrain
/// with slope and bumps: the case of section 5 of the reference page on paper A.
struct RowsAndTurn {
  FlightPath path;
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

/// Errors of a flight along a path, from `from_s` to `to_s`.
struct FlightErrors {
  double lateral_rms_m = 0.0, lateral_max_m = 0.0;   ///< in rows
  double turn_lateral_max_m = 0.0;                   ///< in the turn
  double altitude_max_m = 0.0, speed_max_mps = 0.0;  ///< speed: in rows
  double along_max_m = 0.0, tilt_max_rad = 0.0;
  bool finite = true;
};
/// Flies to the end of the path's time and judges at each tick of the controller.
FlightErrors fly(QuadrotorLoop& loop, const RowsAndTurn& rows, double from_s);

}  // namespace vinerow::test
