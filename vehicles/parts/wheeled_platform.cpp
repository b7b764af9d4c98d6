#include "vehicles/parts/wheeled_platform.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/math/decomposition.h"
#include "vehicles/parts/static_rest.h"
#include "vehicles/parts/step_validity.h"

namespace vinerow::vehicles {
namespace {

/// Parameters of the platform itself; those of its parts are in their own tables. Vehicles fill it.
const ParameterTable<WheeledPlatformParams>& wheeled_platform_table() {
  using P = WheeledPlatformParams;
  static const ParameterTable<P> table =
      ParameterTable<P>().number("mass_kg", "kg", &P::mass_kg, kPositive, "wheels included");
  return table;
}

/// The largest of K v = lambda M v.
double largest_eigenvalue(const Eigen::Matrix3d& K, const Eigen::Matrix3d& M) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> solver(K, M,
                                                                         Eigen::EigenvaluesOnly);
  return solver.eigenvalues().maxCoeff();
}

/// Of all struts together over heave, roll and pitch.
Eigen::Matrix3d calc_strut_matrix(const WheeledPlatformParams& params,
                                  double SuspensionParams::*each) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const WheelParams& wheel : params.wheels) {
    const Eigen::Vector3d lever(1.0, wheel.hub_B.y(), -wheel.hub_B.x());
    sum += wheel.suspension.*each * lever * lever.transpose();
  }
  return sum;
}

/// The springs under a centre of mass at the height h must resist a tilt by more than the m g h by
/// which the weight tips it: softer ones leave the vehicle on its bump stops, and below those a
/// strut would follow the ground for metres.
void demand_upright(double gravity_mps2, const WheeledPlatformParams& params) {
  const Eigen::Matrix3d K = calc_strut_matrix(params, &SuspensionParams::stiffness_N_per_m);
  // Tilting without a heave force.
  const Eigen::Matrix2d tilt =
      K.bottomRightCorner<2, 2>() - K.bottomLeftCorner<2, 1>() * K.topRightCorner<1, 2>() / K(0, 0);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(tilt, Eigen::EigenvaluesOnly);
  double height_m = 0.0;
  for (const WheelParams& wheel : params.wheels) {
    height_m += (wheel.radius_m - wheel.hub_B.z()) / static_cast<double>(params.wheels.size());
  }
  const double holds_Nm = solver.eigenvalues().minCoeff();
  const double tips_Nm = params.mass_kg * gravity_mps2 * height_m;
  if (holds_Nm > tips_Nm) return;
  throw ConfigError(fmt::format(
      "{}: its springs cannot keep it upright: they resist a tilt by {:.3g} Nm/rad, and {:g} kg "
      "with the centre of mass {:.3g} m above the ground tip it by {:.3g} Nm/rad; take springs "
      "(suspension_stiffness_N_per_m) more than {:.4g} times as stiff",
      params.name, holds_Nm, params.mass_kg, height_m, tips_Nm, tips_Nm / holds_Nm));
}

/// Heave, roll and pitch on the struts: a step must be short beside the fastest of them.
void demand_step_for_struts(Duration step, const WheeledPlatformParams& params) {
  const Eigen::Matrix3d K = calc_strut_matrix(params, &SuspensionParams::stiffness_N_per_m);
  const Eigen::Matrix3d D = calc_strut_matrix(params, &SuspensionParams::damping_Ns_per_m);
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  M(0, 0) = params.mass_kg;
  M.bottomRightCorner<2, 2>() = params.inertia_B.topLeftCorner<2, 2>();
  const double angle_rad = std::sqrt(largest_eigenvalue(K, M)) * step.s();
  const double decay = largest_eigenvalue(D, M) * step.s();
  if (angle_rad <= kMaxStrutAngle_rad && decay <= kMaxStrutDecay) return;
  throw ConfigError(fmt::format(
      "{}: physics.step_s = {:g} s is too long for the struts under {:g} kg: they swing {:g} rad "
      "and damp by {:g} in a step, must be at most {:g} rad and {:g}",
      params.name, step.s(), params.mass_kg, angle_rad, decay, kMaxStrutAngle_rad, kMaxStrutDecay));
}

}  // namespace

void WheeledPlatformParams::validate() const {
  wheeled_platform_table().validate(*this, name);
  if (!inertia_B.allFinite() || Eigen::LLT<Eigen::Matrix3d>(inertia_B).info() != Eigen::Success) {
    throw ConfigError(fmt::format("{}: inertia must be finite and positive definite", name));
  }
  if (wheels.size() < 3) {
    throw ConfigError(fmt::format("{}: {} wheels, must be at least 3", name, wheels.size()));
  }
  battery.validate(name);
  air.validate(name);
}

std::vector<double> calc_static_loads(std::span<const Eigen::Vector3d> hubs_B, double weight_N) {
  // Smallest-norm solution of [1; x; y] N = [W; 0; 0]: what equal springs under a rigid body give.
  const auto count = static_cast<Eigen::Index>(hubs_B.size());
  Eigen::MatrixXd A(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector3d& hub = hubs_B[static_cast<std::size_t>(i)];
    A.col(i) = Eigen::Vector3d(1.0, hub.x(), hub.y());
  }
  const Eigen::VectorXd loads = solve_least_norm(A, Eigen::Vector3d(weight_N, 0.0, 0.0));
  const bool balanced = (A * loads - Eigen::Vector3d(weight_N, 0, 0)).norm() < 1e-6 * weight_N;
  if (!balanced || loads.minCoeff() <= 0.0) return {};
  return {loads.data(), loads.data() + count};
}

WheeledPlatform::WheeledPlatform(WheeledPlatformParams params) : params_(std::move(params)) {
  params_.validate();
  for (const WheelParams& wheel : params_.wheels) wheels_.emplace_back(wheel, params_.name);
  state_.wheels.resize(wheels_.size());
  commands_.assign(wheels_.size(), 0.0);
  outputs_.resize(wheels_.size());
  state_.battery.charge = params_.battery.initial_charge;
  for (const WheelParams& wheel : params_.wheels) {
    for (std::string& name : wheel_value_names(wheel.name)) {
      wheels_message_.names.push_back(std::move(name));
    }
  }
  wheels_message_.values.assign(wheels_message_.names.size(), 0.0);
}

void WheeledPlatform::spawn(physics::PhysicsWorld& world, const Pose& X_WB) {
  demand_step(world.settings().step, kMaxWheelStep, params_.name, "its wheels");
  demand_step_for_struts(world.settings().step, params_);
  demand_upright(world.settings().gravity_mps2, params_);
  world_ = &world;
  physics::BodySpec spec;
  spec.name = params_.name;
  spec.mass_kg = params_.mass_kg;
  spec.inertia_B = params_.inertia_B;
  spec.X_WB = X_WB;
  spec.shapes = params_.shapes;
  body_ = world.add_body(spec);
  state_.body = world.state(body_);
  if (wind_random_ && !params_.air.none() && !world.world_model().wind.calm()) {
    wind_.emplace(world.world_model(), world.scene(), *wind_random_);
  }
  // It was parked there.
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    state_.wheels[i].motor.braked = params_.wheels[i].motor.brake_torque_Nm > 0.0;
  }
  come_to_rest();
  state_.specific_force_B =
      state_.body.X_WB.q.conjugate() * Eigen::Vector3d(0.0, 0.0, world.settings().gravity_mps2);
}

void WheeledPlatform::come_to_rest() {
  const auto probe = [this](const Eigen::Vector3d& p, const Eigen::Vector3d& dir, double reach) {
    return world_->probe_ground(p, dir, reach);
  };
  const std::optional<StaticRest> rest =
      find_static_rest(wheels_, state_.wheels, params_.mass_kg * world_->settings().gravity_mps2,
                       state_.body.X_WB, world_->world_model().soil, probe);
  if (!rest) return;
  state_.body.X_WB = rest->X_WB;
  world_->set_state(body_, state_.body);
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    state_.wheels[i].travel_m = rest->travel_m[i];
    state_.wheels[i].tyre.xi = rest->xi[i];
  }
}

void WheeledPlatform::set_forward_speed(double v_mps) {
  state_.body.v_WB_W = state_.body.X_WB.q * Eigen::Vector3d(v_mps, 0.0, 0.0);
  world_->set_state(body_, state_.body);
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    state_.wheels[i].spin_radps = v_mps / params_.wheels[i].radius_m;
    if (v_mps != 0.0) state_.wheels[i].motor.braked = false;
  }
}

void WheeledPlatform::push_by_wind(Time now, Duration dt) {
  if (!wind_) return;
  const physics::BodyState& body = state_.body;
  const double lever_m =
      params_.air.pressure_height_m.value_or(params_.com_height_m) - params_.com_height_m;
  const Eigen::Vector3d lever_W = body.X_WB.q * Eigen::Vector3d(0.0, 0.0, lever_m);
  const Eigen::Vector3d v_W = body.v_WB_W + body.w_WB_W.cross(lever_W);
  const Eigen::Vector3d& wind_W = wind_->sample(now, body.X_WB.p + lever_W, v_W, dt);
  const Eigen::Vector3d f_W =
      body.X_WB.q * calc_air_drag_B(params_.air, wind_->air_density_kgm3(),
                                    body.X_WB.q.conjugate() * Eigen::Vector3d(wind_W - v_W));
  world_->add_central_force_W(body_, f_W);
  world_->add_torque_W(body_, lever_W.cross(f_W));
}

void WheeledPlatform::before_physics(Duration dt) {
  const double dt_s = dt.s();
  if (state_.powered && state_.battery.charge <= 0.0) {
    state_.powered = false;
    for (WheelState& wheel : state_.wheels) wheel.motor.without_current = true;
  }
  const physics::BodyState& body = state_.body;
  const Eigen::Matrix3d R_WB = body.X_WB.q.toRotationMatrix();
  const Soil& soil = world_->world_model().soil;
  const auto probe = [this](const Eigen::Vector3d& p, const Eigen::Vector3d& dir, double reach) {
    return world_->probe_ground(p, dir, reach);
  };

  // All wheels push the body through one force and one moment about its centre of mass.
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero(), torque_W = Eigen::Vector3d::Zero();
  double motors_W = 0.0;
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    WheelState& wheel_state = state_.wheels[i];
    const WheelDisc disc = wheels_[i].disc(wheel_state, body.X_WB.p, R_WB);
    const WheelContact contact = find_wheel_contact(disc, probe);
    outputs_[i] = wheels_[i].step(disc, contact, body.X_WB.p, body.v_WB_W, body.w_WB_W, soil,
                                  commands_[i], dt_s, wheel_state);
    const WheelOutput& out = outputs_[i];
    force_W += out.force_W;
    torque_W += (out.p_W - body.X_WB.p).cross(out.force_W) + out.body_torque_W;
    motors_W += wheel_state.motor.power_W;
  }
  world_->add_central_force_W(body_, force_W);
  world_->add_torque_W(body_, torque_W);
  if (!state_.powered) {  // nothing runs any more
    state_.battery.power_W = 0.0;
    return;
  }
  advance_battery(params_.battery, motors_W, dt_s, state_.battery);
}

void WheeledPlatform::after_physics(Duration dt) {
  const physics::BodyState now = world_->state(body_);
  Eigen::Vector3d f_W = (now.v_WB_W - state_.body.v_WB_W) / dt.s();
  f_W.z() += world_->settings().gravity_mps2;
  state_.specific_force_B = now.X_WB.q.conjugate() * f_W;
  state_.body = now;
}

void WheeledPlatform::read_truth(Odometry& truth) const {
  const Eigen::Quaterniond q_BW = state_.body.X_WB.q.conjugate();
  truth.X_WB = state_.body.X_WB;
  truth.v_WB_B = q_BW * state_.body.v_WB_W;
  truth.w_WB_B = q_BW * state_.body.w_WB_W;
}

std::vector<std::string> wheel_value_names(const std::string& wheel_name) {
  std::vector<std::string> names;
  for (const char* what : {"speed_radps", "steer_rad", "torque_Nm", "load_N", "slip",
                           "slip_angle_rad", "force_x_N", "force_y_N"}) {
    names.push_back(fmt::format("wheel_{}_{}", wheel_name, what));
  }
  VINEROW_DEMAND(names.size() == kWheelValues);
  return names;
}

void WheeledPlatform::connect(Ports& ports) {
  wheels_writer_ = ports.write<NamedValues>("wheels");
  battery_writer_ = ports.write<BatteryState>("battery");
}

void WheeledPlatform::publish(Time now) {
  std::size_t k = 0;
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const WheelState& state = state_.wheels[i];
    const WheelOutput& out = outputs_[i];
    for (const double value : {state.spin_radps, state.steer_rad, state.motor.torque_Nm, out.load_N,
                               out.slip(), out.slip_angle_rad(), out.force_x_N, out.force_y_N}) {
      wheels_message_.values[k++] = value;
    }
  }
  if (wheels_writer_.connected()) wheels_writer_.write(now, wheels_message_);
  if (battery_writer_.connected()) battery_writer_.write(now, state_.battery);
}

}  // namespace vinerow::vehicles
