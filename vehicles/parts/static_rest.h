#pragma once
/// How a body on wheels rests where it is set down: struts and bristles carry it before the first
/// step, so that it does not sink, roll or jolt into its place.
///
/// Rest is the pose and the bristles' deflections at which weight, strut forces N_i n_i and tyre
/// forces F_i have no resultant and no moment about the centre of mass. Six unknowns stand for it:
///
///  - In the wheels' plane the bristles' feet are displaced by one rigid motion q = (u_x, u_y,
///  psi):
///    xi_i = (u + psi z x r_i) / L in the axes of contact i, F_i = N_i (c_x xi_x x_i + c_y xi_y
///    y_i). A wheel without a brake rolls, so that its bristle carries nothing along x. For given
///    loads the three equations along x, y and about z are linear in q.
///  - Heave and two tilts of the body change the struts' travel: by -a_i with a_i = (1, y_i, -x_i)
///    per unit. Newton's method with the Jacobian sum k_i a_i a_i' finds where the three equations
///    along z and about x, y hold, ground and contacts looked up anew each time.
///
/// Deflections beyond the friction ellipse are cut: a vehicle on too steep a slope slides.

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

/// @param states  of the wheels: their steering angles count
/// @param weight_N  of the body  @param X_WB  where it is set down, near its rest
/// @returns nothing where it rests as it is (to a millionth of its weight), or where no rest is
/// found: wheels hang in the air, or the ground is too rough
std::optional<StaticRest> find_static_rest(const std::vector<Wheel>& wheels,
                                           const std::vector<WheelState>& states, double weight_N,
                                           const Pose& X_WB, const Soil& soil,
                                           const GroundProbe& probe);

}  // namespace vinerow::vehicles
