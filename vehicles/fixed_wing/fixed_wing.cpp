#include "vehicles/fixed_wing/fixed_wing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "vehicles/fixed_wing/fixed_wing_mesh.h"
#include "vehicles/fixed_wing/fixed_wing_shapes.h"
#include "vehicles/parts/steering_servo.h"
#include "vehicles/parts/step_validity.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Of the propeller at full throttle, for pictures.
constexpr double kPropeller_radps = 1000.0;

}  // namespace

FixedWing::FixedWing(const FixedWingParams& params, const VehicleContext& context,
                     const LinkShelf& links)
    : params_(params),
      name_(context.vehicle),
      gravity_mps2_(context.gravity_mps2),
      random_(context.random("wind")),
      model_(std::make_shared<FixedWingModel>(params)),
      foliage_(make_foliage_watch(params)),
      hinge_left_X_BE_(elevon_hinge_X_BE(params, 1.0)),
      hinge_right_X_BE_(elevon_hinge_X_BE(params, -1.0)) {
  params_.validate();
  fault_met_.assign(params_.faults.size(), false);
  battery_.charge = params_.battery.initial_charge;
  describe();
  links_ = links.get([&] { return make_links(); });
  air_message_.names = {"airspeed_mps",    "alpha_rad",        "beta_rad", "throttle",
                        "elevon_left_rad", "elevon_right_rad", "thrust_N", "wind_x_mps",
                        "wind_y_mps",      "wind_z_mps"};
  air_message_.values.assign(air_message_.names.size(), 0.0);
}

void FixedWing::spawn(physics::PhysicsWorld& world, const Pose& X_WB) {
  demand_step(world.settings().step, kMaxFlightStep, params_.name, "its wings");
  world_ = &world;
  const Vector3d ground_W = X_WB.p - params_.shape.belly_m * (X_WB.q * Vector3d::UnitZ());
  launcher_.hold(params_.launch, ground_W, yaw_from_quaternion(X_WB.q));
  physics::BodySpec spec;
  spec.name = params_.name;
  spec.mass_kg = params_.mass_kg;
  spec.inertia_B = params_.inertia_B();
  spec.X_WB = launcher_.state().X_WB;
  spec.shapes = make_fixed_wing_shapes(params_);
  spec.friction = params_.belly_friction;
  // The loads given are those of the middle of a step.
  spec.force_sampling = physics::ForceSampling::kHeld;
  body_id_ = world.add_body(spec);
  probe_.emplace(world.world_model(), world.scene(), random_);
  describe_air(calc_air_density_kgm3(world.world_model(), X_WB.p.z()));
  foliage_.start(world.world_model());
  if (params_.launch.mode == LaunchMode::kAir) {
    start_in_air(X_WB, ground_W);
  } else {
    world.set_kinematic(body_id_, true);
    motion_.reset(world.state(body_id_));
  }
  specific_force_B_ = body().X_WB.q.conjugate() * Vector3d(0.0, 0.0, gravity_mps2_);
}

void FixedWing::start_in_air(const Pose& X_WB, const Vector3d& ground_W) {
  const double speed_mps = params_.launch.start_speed_mps;
  const auto flight =
      find_level_flight(params_, speed_mps, gravity_mps2_, probe_->air_density_kgm3());
  if (!flight) {
    throw ConfigError(
        fmt::format("{}: start_speed_mps = {:.4g} allows no level flight: it stalls below {:.1f} "
                    "m/s, or throttle or elevons do not suffice",
                    params_.name, speed_mps, params_.stall_speed_mps(gravity_mps2_)));
  }
  const double yaw_rad = yaw_from_quaternion(X_WB.q);
  const double pitch_rad = params_.launch.start_pitch_rad.value_or(flight->alpha_rad);
  physics::BodyState state;
  state.X_WB.p = ground_W + Vector3d(0.0, 0.0, params_.launch.start_height_m);
  state.X_WB.q = quaternion_from_rpy({0.0, -pitch_rad, yaw_rad});
  const Wind& wind = world_->world_model().wind;
  const Eigen::Vector2d wind_W = mean_wind_mps(wind, params_.launch.start_height_m) *
                                 downwind_direction(wind.from_azimuth_rad);
  state.v_WB_W = {speed_mps * std::cos(yaw_rad) + wind_W.x(),
                  speed_mps * std::sin(yaw_rad) + wind_W.y(), 0.0};
  state.w_WB_W.setZero();
  wind_W_ = {wind_W.x(), wind_W.y(), 0.0};
  set_motion(state, {flight->throttle, flight->elevator_rad, flight->elevator_rad});
}

void FixedWing::set_motion(const physics::BodyState& body, const Actuators& actuators) {
  launcher_.release();
  world_->set_kinematic(body_id_, false);
  world_->set_state(body_id_, body);
  motion_.reset(world_->state(body_id_));
  commands_ = states_ = actuators;
  foliage_.start(world_->world_model());
}

void FixedWing::actuate(std::span<const double> values) {
  VINEROW_ASSERT(values.size() == kActuators);
  std::copy(values.begin(), values.end(), commands_.begin());
}

double FixedWing::wanted_throttle() const {
  return motor_runs_ && crash_.empty() ? commands_[0] : 0.0;
}

void FixedWing::meet_faults(Time now) {
  for (std::size_t k = 0; k < params_.faults.size(); ++k) {
    const FixedWingFault& fault = params_.faults[k];
    if (fault_met_[k] || now.s() < fault.at_s) continue;
    fault_met_[k] = true;
    switch (fault.kind) {
      case FixedWingFault::Kind::kBatteryEmpty:
        battery_.charge = 0.0;
        break;
      case FixedWingFault::Kind::kMotorFailure:
        motor_runs_ = false;
        report_event(Event::Level::kError, "the motor fails");
        break;
      case FixedWingFault::Kind::kElevonStuck: {
        const bool left = fault.left.value_or(true);
        stuck_[left ? 0 : 1] = true;
        report_event(Event::Level::kError,
                     fmt::format("the {} elevon is stuck at {:.1f} deg", left ? "left" : "right",
                                 deg_from_rad(states_[left ? 1 : 2])));
        break;
      }
    }
  }
  if (motor_runs_ && battery_.charge <= 0.0) {
    motor_runs_ = false;
    report_event(Event::Level::kError, "battery empty: the motor stops");
  }
}

void FixedWing::report_event(Event::Level level, std::string text) {
  news_.push_back({level, name_, std::move(text)});
}

double FixedWing::move_actuators(Duration dt, Elevons& middle) {
  const double dt_s = dt.s();
  if (dt != lag_for_) {
    lag_for_ = dt;
    throttle_lag_ = SpeedLag(params_.propeller.lag_s, dt_s);
  }
  const SpeedCourse throttle = throttle_lag_.run(states_[0], wanted_throttle());
  states_[0] = throttle.end_radps;
  propeller_rad_ = wrap_angle(propeller_rad_ + kPropeller_radps * dt_s * throttle.mean_radps);

  const double rate_radps = params_.elevon_rate_radps > 0.0
                                ? params_.elevon_rate_radps
                                : std::numeric_limits<double>::infinity();
  const SteeringServoParams servo{rate_radps, params_.elevon_lag_s};
  std::array<double*, 2> at_middle = {&middle.left_rad, &middle.right_rad};
  for (std::size_t k = 0; k < 2; ++k) {
    double& angle_rad = states_[1 + k];
    const double wanted_rad = stuck_[k] ? angle_rad : commands_[1 + k];
    *at_middle[k] = advance_servo(servo, wanted_rad, 0.5 * dt_s, angle_rad);
    angle_rad = advance_servo(servo, wanted_rad, 0.5 * dt_s, *at_middle[k]);
  }
  return throttle.mean_square;
}

void FixedWing::before_physics(Time now, Duration dt) {
  const double dt_s = dt.s();
  meet_faults(now);
  if (launcher_.holds() && !launcher_.is_pushing() && wanted_throttle() > params_.launch.throttle) {
    launcher_.push(dt_s);
  }
  Elevons elevons;
  const double throttle_square = move_actuators(dt, elevons);

  const physics::BodyState middle = motion_.middle(dt_s);
  if (!probe_->calm()) {
    wind_W_ = probe_->sample(now + Duration{dt.ns / 2}, middle.X_WB.p, middle.v_WB_W, dt);
  }
  const Eigen::Matrix3d R_WB = middle.X_WB.q.toRotationMatrix();
  AirPoint air;
  air.v_air_B = R_WB.transpose() * (middle.v_WB_W - wind_W_);
  air.w_WB_B = R_WB.transpose() * middle.w_WB_W;
  air.air_density_kgm3 = probe_->air_density_kgm3();
  const double airspeed_mps = air.v_air_B.norm();
  thrust_N_ = calc_thrust_N(params_.propeller, air.air_density_kgm3, airspeed_mps, throttle_square);
  if (!launcher_.holds()) {
    const AirLoad load = model_->load(air, throttle_square, elevons);
    world_->add_central_force_W(body_id_, R_WB * load.force_B);
    world_->add_torque_W(body_id_, R_WB * load.torque_B);
  }
  const double motor_W = calc_propeller_power_W(params_.propeller, thrust_N_, airspeed_mps,
                                                std::sqrt(throttle_square));
  if (battery_.charge > 0.0)
    advance_battery(params_.battery, motor_W, dt_s, battery_);
  else
    battery_.power_W = 0.0;
}

void FixedWing::after_physics(Time now, Duration dt) {
  Vector3d f_W(0.0, 0.0, gravity_mps2_);
  if (launcher_.holds()) {
    const physics::BodyState& state = launcher_.advance();
    f_W += launcher_.acceleration_W();
    if (!launcher_.holds()) {
      world_->set_kinematic(body_id_, false);
      report_event(Event::Level::kInfo, fmt::format("launched at {:.1f} m/s", state.v_WB_W.norm()));
    }
    world_->set_state(body_id_, state);
    motion_.take(state, dt.s());
  } else {
    motion_.take(world_->state(body_id_), dt.s());
    f_W += motion_.acceleration_W();
    if (crash_.empty()) {
      crash_ = judge_fixed_wing(*world_, body_id_, motion_.before(), params_);
      if (crash_.empty() && foliage_.touches(world_->scene(), body(), dt.s())) {
        crash_ = fmt::format("touched the canopy at {:.1f} m/s", body().v_WB_W.norm());
      }
    }
  }
  specific_force_B_ = body().X_WB.q.conjugate() * f_W;
  if (!news_.empty() && event_writer_.connected()) {
    event_writer_.write(now, news_.front());
    news_.erase(news_.begin());
  }
}

void FixedWing::read_truth(Odometry& truth) const {
  const Quaterniond q_BW = body().X_WB.q.conjugate();
  truth.X_WB = body().X_WB;
  truth.v_WB_B = q_BW * body().v_WB_W;
  truth.w_WB_B = q_BW * body().w_WB_W;
}

Vector3d FixedWing::air_velocity_B() const {
  return body().X_WB.q.conjugate() * (body().v_WB_W - wind_W_);
}

void FixedWing::read_links(std::vector<Pose>& X_WL) const {
  X_WL[0] = body().X_WB;
  // Trailing edge down is a turn about -y: the part behind the hinge goes down.
  const auto turn = [](double angle_rad) {
    return Pose{Quaterniond(Eigen::AngleAxisd(-angle_rad, Vector3d::UnitY())), Vector3d::Zero()};
  };
  X_WL[1] = body().X_WB * hinge_left_X_BE_ * turn(states_[1]);
  X_WL[2] = body().X_WB * hinge_right_X_BE_ * turn(states_[2]);
  X_WL[3] = body().X_WB * Pose{Quaterniond(Eigen::AngleAxisd(propeller_rad_, Vector3d::UnitX())),
                               propeller_B(params_)};
}

void FixedWing::connect(Ports& ports) {
  air_writer_ = ports.write<NamedValues>("air");
  battery_writer_ = ports.write<BatteryState>("battery");
  event_writer_ = ports.write<Event>("vehicle_event");
}

void FixedWing::publish(Time now) {
  const Vector3d v_B = air_velocity_B();
  const double airspeed_mps = v_B.norm();
  const std::array<double, 10> values = {
      airspeed_mps,
      std::atan2(-v_B.z(), v_B.x()),
      airspeed_mps > 0.0 ? std::asin(std::clamp(-v_B.y() / airspeed_mps, -1.0, 1.0)) : 0.0,
      states_[0],
      states_[1],
      states_[2],
      thrust_N_,
      wind_W_.x(),
      wind_W_.y(),
      wind_W_.z()};
  std::copy(values.begin(), values.end(), air_message_.values.begin());
  if (air_writer_.connected()) air_writer_.write(now, air_message_);
  if (battery_writer_.connected()) battery_writer_.write(now, battery_);
}

std::unique_ptr<Vehicle> make_fixed_wing(const ParameterSet& parameters,
                                         const VehicleContext& context) {
  return std::make_unique<FixedWing>(
      read_fixed_wing_params(parameters, context.vehicle, context.gravity_mps2), context,
      LinkShelf(parameters, context));
}

}  // namespace vinerow::vehicles
