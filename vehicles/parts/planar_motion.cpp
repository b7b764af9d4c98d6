#include "vehicles/parts/planar_motion.h"

#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::vehicles {

void set_planar_twist(double left_mps, double right_mps, double track_m, PlanarState& state) {
  state.v_mps = 0.5 * (left_mps + right_mps);
  state.yaw_rate_radps = (right_mps - left_mps) / track_m;
}

void advance_planar(double dt_s, PlanarState& state) {
  const double half = 0.5 * state.yaw_rate_radps * dt_s;
  // sin(a)/a to full precision: below 1e-4 the next term of the series is under 1e-18.
  const double sinc = std::abs(half) < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
  const double chord = state.v_mps * dt_s * sinc;
  const double direction = state.yaw_rad + half;
  state.p_W += chord * Eigen::Vector2d(std::cos(direction), std::sin(direction));
  state.yaw_rad = wrap_angle(state.yaw_rad + 2.0 * half);
}

}  // namespace vinerow::vehicles
