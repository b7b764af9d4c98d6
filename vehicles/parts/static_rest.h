#pragma once
/// Static equilibrium of a body on wheels. A vehicle that is placed starts with loaded struts and
/// bristles, so that it does not sink, roll or jolt in its first steps.
///
/// At rest, weight, strut forces N_i n_i and tyre forces F_i have no resultant and no moment about
/// the centre of mass. There are six unknowns:
///
///  - In the plane of the wheels, one rigid motion q = (u_x, u_y, psi) displaces the bristles:
///    xi_i = (u + psi z x r_i) / L in the axes of contact i, and
///    F_i = N_i (c_x xi_x x_i + c_y xi_y y_i). A wheel without a brake rolls, so that its bristle
///    carries nothing along x. For given loads the three equations along x, y and about z are
///    linear in q.
///  - Heave and two tilts of the body change the travel of the struts by -a_i per unit, with
///    a_i = (1, y_i, -x_i). Newton's method with the Jacobian sum k_i a_i a_i' solves the three
///    equations along z and about x, y. Ground and contacts are looked up again at each iteration.
///
/// Deflections beyond the friction ellipse are cut: on too steep a slope a vehicle slides.

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "engine/api/soil.h"
#include "engine/math/pose.h"
#include "engine/physics/physics_world.h"
#include "vehicles/parts/wheel.h"

namespace vinerow::vehicles {

struct StaticRest {
  Pose X_WB;
  std::vector<double> travel_m;     ///< of each wheel's hub
  std::vector<Eigen::Vector2d> xi;  ///< TyreState::xi of each wheel
};

using GroundProbe = std::function<std::optional<physics::GroundHit>(
    const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W, double max_distance_m)>;

/// @param states  of the wheels; only the steering angles are used
/// @param weight_N  of the body
/// @param X_WB  pose in which it is placed, near its rest
/// @returns null if it is at rest already (to a millionth of its weight), or if no rest is found
/// because wheels hang in the air or the ground is too rough
std::optional<StaticRest> find_static_rest(const std::vector<Wheel>& wheels,
                                           const std::vector<WheelState>& states, double weight_N,
                                           const Pose& X_WB, const Soil& soil,
                                           const GroundProbe& probe);

}  // namespace vinerow::vehicles
