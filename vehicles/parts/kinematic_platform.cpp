#include "vehicles/parts/kinematic_platform.h"

#include <array>
#include <cmath>

#include "engine/api/messages/motion.h"
#include "engine/api/parameter_table.h"

namespace vinerow::vehicles {
namespace {

/// The ground is looked for from this far above the wheels to this far below.
constexpr double kSearchUp_m = 1.0;
constexpr double kSearchDown_m = 3.0;

/// Vehicles fill it.
const ParameterTable<KinematicPlatformParams>& kinematic_platform_table() {
  using P = KinematicPlatformParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("track_m", "m", &P::track_m, kPositive, "left to right wheel centre")
          .number("wheel_base_m", "m", &P::wheel_base_m, kPositive, "front to rear axle");
  return table;
}

}  // namespace

KinematicPlatform::KinematicPlatform(KinematicPlatformParams params) : params_(std::move(params)) {
  kinematic_platform_table().validate(params_, params_.name);
}

void KinematicPlatform::spawn(physics::PhysicsWorld& world, const Pose& X_WB) {
  world_ = &world;
  physics::BodySpec spec;
  spec.name = params_.name;
  spec.mass_kg = params_.mass_kg;
  spec.inertia_B = params_.inertia_B;
  spec.X_WB = X_WB;
  spec.shapes = params_.shapes;
  body_ = world.add_body(spec);
  world.set_kinematic(body_, true);
  state_.planar.p_W = X_WB.p.head<2>();
  state_.planar.yaw_rad = yaw_from_quaternion(X_WB.q);
  state_.body.X_WB = X_WB;
  state_.body.v_WB_W.setZero();
  state_.body.w_WB_W.setZero();
  place_on_ground(0.0);
  state_.specific_force_B =
      state_.body.X_WB.q.conjugate() * Eigen::Vector3d(0, 0, world.settings().gravity_mps2);
  world.set_state(body_, state_.body);
}

void KinematicPlatform::command(double left_mps, double right_mps) {
  set_planar_twist(left_mps, right_mps, params_.track_m, state_.planar);
}

void KinematicPlatform::place_on_ground(double dt_s) {
  const PlanarState& planar = state_.planar;
  const double c = std::cos(planar.yaw_rad), s = std::sin(planar.yaw_rad);
  const Eigen::Vector2d forward(0.5 * params_.wheel_base_m * c, 0.5 * params_.wheel_base_m * s);
  const Eigen::Vector2d left(-0.5 * params_.track_m * s, 0.5 * params_.track_m * c);
  const double z_before = state_.body.X_WB.p.z() - params_.height_above_ground_m;

  std::array<Eigen::Vector3d, 4> feet;
  bool found = true;
  for (std::size_t i = 0; i < 4; ++i) {
    const double along = i < 2 ? 1.0 : -1.0, across = i % 2 == 0 ? 1.0 : -1.0;
    const Eigen::Vector2d xy = planar.p_W + along * forward + across * left;
    const Eigen::Vector3d start(xy.x(), xy.y(), z_before + kSearchUp_m);
    const auto hit =
        world_->probe_ground(start, -Eigen::Vector3d::UnitZ(), kSearchUp_m + kSearchDown_m);
    found = found && hit.has_value();
    feet[i] = {xy.x(), xy.y(), hit ? start.z() - hit->distance_m : z_before};
  }
  Pose& X_WB = state_.body.X_WB;
  double z = X_WB.p.z();
  Eigen::Quaterniond q = quaternion_on_slope(planar.yaw_rad, X_WB.q * Eigen::Vector3d::UnitZ());
  if (found) {
    // Least-squares plane through four points of a rectangle: its directions are the diagonals'
    // sums.
    const Eigen::Vector3d x_dir = feet[0] + feet[1] - feet[2] - feet[3];
    const Eigen::Vector3d y_dir = feet[0] + feet[2] - feet[1] - feet[3];
    const Eigen::Vector3d normal = x_dir.cross(y_dir).normalized();
    const double ground = 0.25 * (feet[0].z() + feet[1].z() + feet[2].z() + feet[3].z());
    q = quaternion_on_slope(planar.yaw_rad, normal);
    z = ground + params_.height_above_ground_m / normal.z();
  }
  state_.climb_rate_mps = dt_s > 0.0 ? (z - X_WB.p.z()) / dt_s : 0.0;
  X_WB.p = {planar.p_W.x(), planar.p_W.y(), z};
  X_WB.q = q;
}

void KinematicPlatform::before_physics(Duration dt) {
  const double dt_s = dt.s();
  const Eigen::Vector3d v_before = state_.body.v_WB_W;
  advance_planar(dt_s, state_.planar);
  place_on_ground(dt_s);
  const PlanarState& planar = state_.planar;
  state_.body.v_WB_W = {planar.v_mps * std::cos(planar.yaw_rad),
                        planar.v_mps * std::sin(planar.yaw_rad), state_.climb_rate_mps};
  state_.body.w_WB_W = {0.0, 0.0, planar.yaw_rate_radps};
  world_->set_state(body_, state_.body);
  Eigen::Vector3d f_W = (state_.body.v_WB_W - v_before) / dt_s;
  f_W.z() += world_->settings().gravity_mps2;
  state_.specific_force_B = state_.body.X_WB.q.conjugate() * f_W;
}

void KinematicPlatform::read_truth(Odometry& truth) const {
  const Eigen::Quaterniond q_BW = state_.body.X_WB.q.conjugate();
  truth.X_WB = state_.body.X_WB;
  truth.v_WB_B = q_BW * state_.body.v_WB_W;
  truth.w_WB_B = q_BW * state_.body.w_WB_W;
}

}  // namespace vinerow::vehicles
