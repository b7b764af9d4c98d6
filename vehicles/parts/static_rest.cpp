#include "vehicles/parts/static_rest.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "engine/math/decomposition.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Plan, with the symbols of static_rest.h. Each iteration
//
//   1. finds contacts and loads N_i at the pose (find_foot),
//   2. solves the plane: (sum_i L (hold_x a_x a_x' + hold_y a_y a_y')) q = -(force_x, force_y,
//      moment_z), where a = share of q in the displacement along a contact's axis, over L, and
//      hold = N c (N per unit of xi),
//   3. adds the tyre forces, cut to the ellipse, and takes the residual (force_z, moment_x,
//      moment_y),
//   4. ends if the residual is small, else moves the body by the Newton step
//      (sum_i k_i a_i a_i') step = residual.

// Newton's method needs a few iterations on a plane; more are used up on rough ground, on which
// contacts jump. Chosen.
constexpr int kMaxIterations = 30;
constexpr double kResidual = 1e-6;  // of the weight, and of the weight times 1 m; chosen
// As in wheel.cpp: smallest cosine between strut and ground normal.
constexpr double kMinUpright = 0.2;
constexpr int kMinFeet = 3;  // fewer leave a tilt free

/// Forces at one pose.
struct Balance {
  Vector3d tilt = Vector3d::Zero();   ///< residual along z, about x, about y of B
  Vector3d plane = Vector3d::Zero();  ///< load on the bristles along x, y, about z of B
  Matrix3d tilt_stiffness = Matrix3d::Zero();
  std::vector<double> travel_m;
  std::vector<Vector2d> xi;
  bool stands = false;  ///< enough wheels carry load
};

/// Contact of one wheel, in B.
struct Foot {
  double load_N = 0.0;
  double stiffness_N_per_m = 0.0;
  Vector3d r_B, n_B, x_B, y_B;
  double hold_x = 0.0, hold_y = 0.0;  ///< N per unit of xi
};

Foot find_foot(const Wheel& wheel, const WheelDisc& disc, const WheelContact& contact,
               const Soil& soil, const Pose& X_WB) {
  Foot foot;
  const WheelParams& p = wheel.params();
  const double upright = std::max(disc.z_W.dot(contact.normal_W), kMinUpright);
  foot.load_N = calc_suspension_force(p.suspension, contact.travel_m, 0.0) / upright;
  foot.stiffness_N_per_m =
      p.suspension.stiffness_N_per_m +
      (contact.travel_m > p.suspension.bump_travel_m ? p.suspension.bump_stiffness_N_per_m : 0.0);
  const Eigen::Quaterniond q_BW = X_WB.q.conjugate();
  foot.r_B = q_BW * Vector3d(contact.p_W - X_WB.p);
  foot.n_B = q_BW * contact.normal_W;
  foot.x_B = (q_BW * Vector3d(disc.y_W.cross(contact.normal_W))).normalized();
  foot.y_B = foot.n_B.cross(foot.x_B);
  const bool rolls = p.motor.brake_torque_Nm == 0.0;
  foot.hold_x = rolls ? 0.0 : foot.load_N * soil.slip_stiffness;
  foot.hold_y = foot.load_N * soil.cornering_stiffness_per_rad;
  return foot;
}

/// Displacement of a bristle along an axis per unit of q = (u_x, u_y, psi), over L.
Vector3d calc_share(const Foot& foot, const Vector3d& axis_B, double relaxation_m) {
  const Vector3d turned = Vector3d::UnitZ().cross(foot.r_B);
  return Vector3d(axis_B.x(), axis_B.y(), turned.dot(axis_B)) / relaxation_m;
}

Balance calc_balance(const std::vector<Wheel>& wheels, const std::vector<WheelState>& states,
                     double weight_N, const Pose& X_WB, const Soil& soil,
                     const GroundProbe& probe) {
  // Loads, with the resultant and moment of weight and struts, in B.
  Balance balance;
  const Matrix3d R_WB = X_WB.q.toRotationMatrix();
  std::vector<Foot> feet(wheels.size());
  Vector3d force_B = R_WB.transpose() * Vector3d(0.0, 0.0, -weight_N);
  Vector3d moment_B = Vector3d::Zero();
  int stationary = 0;
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    const WheelDisc disc = wheels[i].disc(states[i], X_WB.p, R_WB);
    const WheelContact contact = find_wheel_contact(disc, probe);
    balance.travel_m.push_back(contact.travel_m);
    if (!contact.touches) continue;
    feet[i] = find_foot(wheels[i], disc, contact, soil, X_WB);
    if (feet[i].load_N <= 0.0) continue;
    ++stationary;
    const Vector3d strut_B = feet[i].load_N * feet[i].n_B;
    force_B += strut_B;
    moment_B += feet[i].r_B.cross(strut_B);
    const Vector3d a(1.0, feet[i].r_B.y(), -feet[i].r_B.x());
    balance.tilt_stiffness += feet[i].stiffness_N_per_m * a * a.transpose();
  }
  balance.stands = stationary >= kMinFeet;
  if (!balance.stands) return balance;
  balance.plane = -Vector3d(force_B.x(), force_B.y(), moment_B.z());

  // Stiffness of all bristles against q.
  Matrix3d hold = Matrix3d::Zero();
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    if (feet[i].load_N <= 0.0) continue;
    const double relaxation_m = wheels[i].params().tyre.relaxation_length_m;
    // A force along an axis acts on (x, y, about z) with the same coefficients as q displaces the
    // bristle along it, hence the outer products; L undoes one of the two divisions.
    const Vector3d along = calc_share(feet[i], feet[i].x_B, relaxation_m);
    const Vector3d across = calc_share(feet[i], feet[i].y_B, relaxation_m);
    hold += relaxation_m * (feet[i].hold_x * along * along.transpose() +
                            feet[i].hold_y * across * across.transpose());
  }
  // If no wheel holds along x, the matrix is singular; the least-norm solution has no part there.
  const Vector3d q = solve_least_norm(hold, balance.plane);
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    const WheelParams& p = wheels[i].params();
    Vector2d xi = Vector2d::Zero();
    if (feet[i].load_N > 0.0) {
      const double relaxation_m = p.tyre.relaxation_length_m;
      if (feet[i].hold_x > 0.0) xi.x() = calc_share(feet[i], feet[i].x_B, relaxation_m).dot(q);
      xi.y() = calc_share(feet[i], feet[i].y_B, relaxation_m).dot(q);
      const Vector2d used(xi.x() * soil.slip_stiffness / soil.peak_friction,
                          xi.y() * soil.cornering_stiffness_per_rad /
                              (soil.peak_friction * p.tyre.lateral_friction_ratio));
      if (used.norm() > 1.0) xi /= used.norm();
      const Vector3d tyre_B =
          feet[i].hold_x * xi.x() * feet[i].x_B + feet[i].hold_y * xi.y() * feet[i].y_B;
      force_B += tyre_B;
      moment_B += feet[i].r_B.cross(tyre_B);
    }
    balance.xi.push_back(xi);
  }
  balance.tilt = {force_B.z(), moment_B.x(), moment_B.y()};
  return balance;
}

}  // namespace

std::optional<StaticRest> find_static_rest(const std::vector<Wheel>& wheels,
                                           const std::vector<WheelState>& states, double weight_N,
                                           const Pose& X_WB, const Soil& soil,
                                           const GroundProbe& probe) {
  if (!(weight_N > 0.0)) return std::nullopt;  // no force towards the ground
  const double small = kResidual * weight_N;
  Pose pose = X_WB;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Balance balance = calc_balance(wheels, states, weight_N, pose, soil, probe);
    if (!balance.stands) return std::nullopt;
    if (balance.tilt.cwiseAbs().maxCoeff() <= small) {
      const bool as_it_is = iteration == 0 && balance.plane.cwiseAbs().maxCoeff() <= small;
      if (as_it_is) return std::nullopt;
      return StaticRest{pose, std::move(balance.travel_m), std::move(balance.xi)};
    }
    const Vector3d step = solve_least_norm(balance.tilt_stiffness, balance.tilt);
    pose.p += pose.q * Vector3d(0.0, 0.0, step.x());
    const Vector3d turn(step.y(), step.z(), 0.0);
    if (turn.norm() > 0.0) {
      pose.q = (pose.q * Eigen::AngleAxisd(turn.norm(), turn.normalized())).normalized();
    }
  }
  return std::nullopt;
}

}  // namespace vinerow::vehicles
