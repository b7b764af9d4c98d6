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

constexpr int kMostIterations = 30;
constexpr double kResidual = 1e-6;  ///< of the weight, and of the weight times 1 m

/// Forces at one pose.
struct Balance {
  Vector3d tilt = Vector3d::Zero();   ///< left over along z, about x, about y of B
  Vector3d plane = Vector3d::Zero();  ///< to be carried by the bristles: along x, y, about z
  Matrix3d tilt_stiffness = Matrix3d::Zero();
  std::vector<double> travel_m;
  std::vector<Vector2d> xi;
  bool stands = false;
};

/// What one wheel does to its body, in B.
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
  const double upright = std::max(disc.z_W.dot(contact.normal_W), 0.2);
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

/// Displacement of a bristle's foot per unit of (u_x, u_y, psi), times one over L, along an axis.
Vector3d calc_share(const Foot& foot, const Vector3d& axis_B, double relaxation_m) {
  const Vector3d turned = Vector3d::UnitZ().cross(foot.r_B);
  return Vector3d(axis_B.x(), axis_B.y(), turned.dot(axis_B)) / relaxation_m;
}

Balance calc_balance(const std::vector<Wheel>& wheels, const std::vector<WheelState>& states,
                     double weight_N, const Pose& X_WB, const Soil& soil,
                     const GroundProbe& probe) {
  Balance balance;
  const Matrix3d R_WB = X_WB.q.toRotationMatrix();
  std::vector<Foot> feet(wheels.size());
  Vector3d force_B = R_WB.transpose() * Vector3d(0.0, 0.0, -weight_N);
  Vector3d moment_B = Vector3d::Zero();
  int standing = 0;
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    const WheelDisc disc = wheels[i].disc(states[i], X_WB.p, R_WB);
    const WheelContact contact = find_wheel_contact(disc, probe);
    balance.travel_m.push_back(contact.travel_m);
    if (!contact.touches) continue;
    feet[i] = find_foot(wheels[i], disc, contact, soil, X_WB);
    if (feet[i].load_N <= 0.0) continue;
    ++standing;
    const Vector3d strut_B = feet[i].load_N * feet[i].n_B;
    force_B += strut_B;
    moment_B += feet[i].r_B.cross(strut_B);
    const Vector3d a(1.0, feet[i].r_B.y(), -feet[i].r_B.x());
    balance.tilt_stiffness += feet[i].stiffness_N_per_m * a * a.transpose();
  }
  balance.stands = standing >= 3;
  if (!balance.stands) return balance;
  balance.plane = -Vector3d(force_B.x(), force_B.y(), moment_B.z());

  Matrix3d hold = Matrix3d::Zero();
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    if (feet[i].load_N <= 0.0) continue;
    const double relaxation_m = wheels[i].params().tyre.relaxation_length_m;
    // Force along an axis acts on (x, y, about z) as displacement along it comes of (u, psi).
    const Vector3d along = calc_share(feet[i], feet[i].x_B, relaxation_m);
    const Vector3d across = calc_share(feet[i], feet[i].y_B, relaxation_m);
    hold += relaxation_m * (feet[i].hold_x * along * along.transpose() +
                            feet[i].hold_y * across * across.transpose());
  }
  // Where nothing holds along x the least norm leaves that open.
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
  if (!(weight_N > 0.0)) return std::nullopt;  // nothing presses it to the ground
  const double small = kResidual * weight_N;
  Pose pose = X_WB;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
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
