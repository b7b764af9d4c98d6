#pragma once
/// Kinematic model of a skid-steered vehicle, as in paper B: pure rolling, no masses.
///
/// Source: paper B (AgriEngineering 6, 2024), section 2.1, eq. 1-2, with the half track:
///   v = (v_left + v_right) / 2,  w = (v_right - v_left) / track.
/// The pose moves in the horizontal plane along the exact arc of a constant twist.

#include <Eigen/Core>

namespace vinerow::vehicles {

struct PlanarState {
  Eigen::Vector2d p_W = Eigen::Vector2d::Zero();
  double yaw_rad = 0.0;  ///< wrapped to (-pi, pi]
  double v_mps = 0.0;    ///< of the last step
  double yaw_rate_radps = 0.0;
};

/// Sets forward speed and yaw rate from the rim speeds of both sides.
void set_planar_twist(double left_mps, double right_mps, double track_m, PlanarState& state);

/// Advances along the exact arc over dt: chord v dt sin(a)/a in the direction yaw + a, with
/// a = w dt / 2. Two arcs of dt/2 equal one of dt up to round-off.
void advance_planar(double dt_s, PlanarState& state);

}  // namespace vinerow::vehicles
