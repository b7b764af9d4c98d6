#include "vehicles/quadrotor/quadrotor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/height_field.h"
#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/core/constants.h"
#include "vehicles/parts/step_validity.h"
#include "vehicles/quadrotor/crash_watch.h"
#include "vehicles/quadrotor/quadrotor_shapes.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Air density at which the rotors' coefficients hold.
constexpr double kRatedDensity_kgm3 = 1.225;

/// Of carbon and plastic on soil, where not the feet stand on it.
constexpr double kHullFriction = 0.5;
/// Below this height of the legs' ends the feet look for the ground one by one.
constexpr double kFeetLook_m = 0.5;

/// 1/2 rho C_d A |v| v, along the air's velocity relative to the body.
Vector3d calc_body_drag_W(double drag_area_m2, double air_density_kgm3, const Vector3d& air_W) {
  return (0.5 * air_density_kgm3 * drag_area_m2 * air_W.norm()) * air_W;
}

/// Beyond the limit its landing gear crashes where it stands.
void demand_flat_start(const Pose& X_WB, const QuadrotorParams& params) {
  const double tilt_rad = calc_tilt_rad(X_WB.q);
  if (tilt_rad <= params.landing_tilt_limit_rad) return;
  throw ConfigError(fmt::format(
      "{}: the ground of its start slopes by {:.1f} deg, must be at most landing_tilt_limit_deg = "
      "{:.1f} deg",
      params.name, deg_from_rad(tilt_rad), deg_from_rad(params.landing_tilt_limit_rad)));
}

/// Heave and tilt on the four legs. With A^2 the stiffness and D the damping over the inertia,
/// times the step squared and the step, a semi-implicit step is stable for D + A^2 / 2 < 2. The
/// shipped quadrotors have 1.5 at the longest step, 10 ms; a fifth of the limit is left.
void demand_step_for_gear(Duration step, const QuadrotorParams& params) {
  constexpr double kMost = 1.6;
  const double r2_m2 = params.gear_radius_m * params.gear_radius_m;
  const double inertia_kgm2 = params.inertia_kgm2.head<2>().minCoeff();
  double longest_s = kInfinity;
  for (const double legs_per_kg :
       {kRotors / params.mass_kg, 0.5 * kRotors * r2_m2 / inertia_kgm2}) {
    const double a = params.foot.stiffness_N_per_m * legs_per_kg;
    const double d = params.foot.damping_Ns_per_m * legs_per_kg;
    longest_s = std::min(longest_s, 2.0 * kMost / (d + std::sqrt(d * d + 2.0 * kMost * a)));
  }
  if (step.s() <= longest_s) return;
  throw ConfigError(
      fmt::format("{}: physics.step_s = {:g} s is too long for its landing gear, which with "
                  "gear_stiffness_N_per_m = {:g}, gear_damping_Ns_per_m = {:g} and its mass and "
                  "inertia is valid to {:.2g} s",
                  params.name, step.s(), params.foot.stiffness_N_per_m,
                  params.foot.damping_Ns_per_m, longest_s));
}

}  // namespace

Quadrotor::Quadrotor(const QuadrotorParams& params, const VehicleContext& context,
                     const LinkShelf& links)
    : params_(params),
      name_(context.vehicle),
      random_(context.random("wind")),
      foliage_(make_foliage_watch(params)),
      ground_effect_(params.ground_effect, params.rotor_radius_m, params.arm_m,
                     params.ground_effect_body_lift),
      rotor_air_(params.rotor_air()) {
  params_.validate(context.gravity_mps2);
  params_.foot.static_load_N = params_.mass_kg * context.gravity_mps2 / kRotors;
  for (std::size_t i = 0; i < kRotors; ++i)
    hubs_B_[i] = params_.hub_B(i), feet_B_[i] = params_.foot_B(i);
  fault_met_.assign(params_.faults.size(), false);
  actuator_states_.assign(kRotors, 0.0);
  battery_.charge = params_.battery.initial_charge;
  describe();
  links_ = links.get([&] { return make_links(); });
  for (std::size_t i = 1; i <= kRotors; ++i) {
    rotors_message_.names.push_back(fmt::format("rotor_{}_speed_radps", i));
    rotors_message_.names.push_back(fmt::format("rotor_{}_thrust_N", i));
  }
  for (const char* axis : {"x", "y", "z"}) {
    rotors_message_.names.push_back(fmt::format("wind_{}_mps", axis));
  }
  rotors_message_.values.assign(rotors_message_.names.size(), 0.0);
}

void Quadrotor::spawn(physics::PhysicsWorld& world, const Pose& X_WB) {
  demand_step(world.settings().step, kMaxFlightStep, params_.name, "its rotors");
  demand_step_for_gear(world.settings().step, params_);
  demand_flat_start(X_WB, params_);
  world_ = &world;
  physics::BodySpec spec;
  spec.name = params_.name;
  spec.mass_kg = params_.mass_kg;
  spec.inertia_B = params_.inertia_kgm2.asDiagonal();
  spec.X_WB = X_WB;
  spec.shapes = make_quadrotor_shapes(params_);
  spec.friction = kHullFriction;
  // The loads given are means over the step.
  spec.force_sampling = physics::ForceSampling::kHeld;
  body_id_ = world.add_body(spec);
  motion_.reset(world.state(body_id_));
  specific_force_B_ = X_WB.q.conjugate() * Vector3d(0.0, 0.0, world.settings().gravity_mps2);
  probe_.emplace(world.world_model(), world.scene(), random_);
  describe_air(calc_air_density_kgm3(world.world_model(), X_WB.p.z()) / kRatedDensity_kgm3);
  foliage_.start(world.world_model());
}

void Quadrotor::set_motion(const physics::BodyState& body,
                           const std::array<double, kRotors>& speeds_radps) {
  world_->set_state(body_id_, body);
  motion_.reset(body);
  for (std::size_t i = 0; i < kRotors; ++i) {
    rotors_[i].speed_radps = actuator_states_[i] = commands_radps_[i] = speeds_radps[i];
  }
  booked_momentum_W_ = body.X_WB.q * Vector3d(0.0, 0.0, rotor_momentum_Nms());
  feet_ = {};
  foliage_.start(world_->world_model());
}

double Quadrotor::rotor_momentum_Nms() const {
  double sum_radps = 0.0;
  for (std::size_t i = 0; i < kRotors; ++i) {
    sum_radps -= QuadrotorParams::torque_sign(i) * rotors_[i].speed_radps;
  }
  return params_.rotor.inertia_kgm2 * sum_radps;
}

Vector3d Quadrotor::angular_momentum_W() const {
  const Vector3d w_B = body().X_WB.q.conjugate() * body().w_WB_W;
  const Vector3d rotors_B(0.0, 0.0, rotor_momentum_Nms());
  return body().X_WB.q * (params_.inertia_kgm2.cwiseProduct(w_B) + rotors_B);
}

void Quadrotor::actuate(std::span<const double> values) {
  VINEROW_ASSERT(values.size() == kRotors);
  std::copy(values.begin(), values.end(), commands_radps_.begin());
}

double Quadrotor::wanted_radps(std::size_t rotor) const {
  return powered_ && crash_.empty() ? commands_radps_[rotor] * speed_share_[rotor] : 0.0;
}

void Quadrotor::meet_faults(Time now) {
  for (std::size_t k = 0; k < params_.faults.size(); ++k) {
    const QuadrotorFault& fault = params_.faults[k];
    if (fault_met_[k] || now.s() < fault.at_s) continue;
    fault_met_[k] = true;
    if (fault.kind == QuadrotorFault::Kind::kBatteryEmpty) {
      battery_.charge = 0.0;
      continue;
    }
    // Thrust goes with the speed squared.
    const double remaining = fault.remaining.value_or(0.0);
    speed_share_[*fault.rotor] = std::sqrt(remaining);
    report_event(Event::Level::kError, fmt::format("rotor {} fails: {:.0f} % of its thrust left",
                                                   *fault.rotor + 1, 100.0 * remaining));
  }
  if (powered_ && battery_.charge <= 0.0) {
    powered_ = false;
    report_event(Event::Level::kError, "battery empty: the rotors stop");
  }
}

void Quadrotor::report_event(Event::Level level, std::string text) {
  news_.push_back({level, name_, std::move(text)});
}

void Quadrotor::feel_wind(Time now, Duration dt) {
  if (!probe_->calm()) wind_W_ = probe_->sample(now, body().X_WB.p, body().v_WB_W, dt);
}

void Quadrotor::feel_ground() {
  for (RotorState& rotor : rotors_) rotor.thrust_ratio = 1.0;
  const double feet_reach_m = params_.stand_height_m + params_.gear_radius_m + kFeetLook_m;
  const double reach_m = std::max(ground_effect_.reach_m(), feet_reach_m);
  const Vector3d& p_W = body().X_WB.p;
  const auto hit = world_->probe_ground(p_W, -Vector3d::UnitZ(), reach_m);
  ground_is_near_ = hit && hit->distance_m < feet_reach_m;
  if (!hit || ground_effect_.reach_m() <= 0.0) return;
  Vector3d ground_W = p_W - hit->distance_m * Vector3d::UnitZ(), normal_W = hit->normal_W;
  const bool is_wide =
      hit->surface == SurfaceClass::kTerrain || hit->surface == SurfaceClass::kObstacle;
  const std::optional<HeightField>& terrain = world_->world_model().terrain;
  if (!is_wide && terrain) {  // the top of a post throws no wake back
    ground_W.z() = terrain->height_m(p_W.x(), p_W.y());
    normal_W = terrain->normal_W(p_W.x(), p_W.y());
  }
  const Vector3d normal_B = body().X_WB.q.conjugate() * normal_W;
  const double height_m = normal_W.dot(p_W - ground_W);
  for (std::size_t i = 0; i < kRotors; ++i) {
    rotors_[i].thrust_ratio =
        ground_effect_.thrust_ratio(height_m + normal_B.dot(hubs_B_[i]), normal_B.z());
  }
}

void Quadrotor::press_feet(Vector3d& force_W, Vector3d& torque_W) {
  for (std::size_t i = 0; i < kRotors; ++i) {
    if (!ground_is_near_) {
      feet_[i].stands = false;
      continue;
    }
    const auto contact = press_foot(params_.foot, *world_, body(), feet_B_[i], feet_[i]);
    if (!contact) continue;
    force_W += contact->force_W;
    torque_W += (contact->p_W - body().X_WB.p).cross(contact->force_W);
    if (crash_.empty()) crash_ = find_crash_at_foot(*contact, body(), params_);
  }
}

Quadrotor::Load Quadrotor::run_rotors(double dt_s, const Vector3d& air_B, const Vector3d& w_B) {
  const double density = probe_->air_density_kgm3() / kRatedDensity_kgm3;
  Load load;
  for (std::size_t i = 0; i < kRotors; ++i) {
    RotorState& rotor = rotors_[i];
    const SpeedCourse course = lags_.run(rotor.speed_radps, wanted_radps(i));
    const double sign = QuadrotorParams::torque_sign(i);
    const Vector3d air_at_hub_B = air_B - w_B.cross(hubs_B_[i]);
    Vector3d force_B = density * rotor_air_.force_B(course.mean_radps, air_at_hub_B);
    rotor.thrust_N = force_B.z() + density * rotor.thrust_ratio *
                                       params_.rotor.thrust_coefficient_Ns2 * course.mean_square;
    force_B.z() = rotor.thrust_N;
    load.force_B += force_B;
    load.torque_B += hubs_B_[i].cross(force_B);
    const double drag = density * params_.rotor.torque_coefficient_Nms2;
    load.torque_B.z() += sign * drag * course.mean_square;
    load.shaft_W += drag * course.mean_cube;
    rotor.speed_radps = course.end_radps;
    rotor.angle_rad = wrap_angle(rotor.angle_rad - sign * course.mean_radps * dt_s);
    actuator_states_[i] = course.end_radps;
  }
  return load;
}

void Quadrotor::before_physics(Time now, Duration dt) {
  const double dt_s = dt.s();
  if (dt != lags_for_) {
    lags_for_ = dt;
    lags_ = RotorLags(params_.rotor, dt_s);
  }
  meet_faults(now);
  feel_wind(now, dt);
  feel_ground();

  // The middle of the step, from what the last step changed.
  const physics::BodyState middle = motion_.middle(dt_s);
  const Vector3d& w_W = middle.w_WB_W;
  const Eigen::Matrix3d R_WB = middle.X_WB.q.toRotationMatrix();
  const Vector3d air_W = wind_W_ - middle.v_WB_W;

  Load load = run_rotors(dt_s, R_WB.transpose() * air_W, R_WB.transpose() * w_W);
  const Vector3d momentum_W =
      turned_on(body().X_WB.q, dt_s * w_W) * Vector3d(0.0, 0.0, rotor_momentum_Nms());
  Vector3d force_W = R_WB * load.force_B +
                     calc_body_drag_W(params_.body_drag_area_m2, probe_->air_density_kgm3(), air_W);
  Vector3d torque_W = R_WB * load.torque_B - (momentum_W - booked_momentum_W_) / dt_s;
  press_feet(force_W, torque_W);
  world_->add_central_force_W(body_id_, force_W);
  world_->add_torque_W(body_id_, torque_W);
  booked_momentum_W_ = momentum_W;

  if (!powered_) {  // nothing runs any more
    battery_.power_W = 0.0;
    return;
  }
  advance_battery(params_.battery, load.shaft_W / params_.motor_efficiency, dt_s, battery_);
}

void Quadrotor::after_physics(Time now, Duration dt) {
  motion_.take(world_->state(body_id_), dt.s());
  Vector3d f_W = motion_.acceleration_W();
  f_W.z() += world_->settings().gravity_mps2;
  specific_force_B_ = body().X_WB.q.conjugate() * f_W;
  if (crash_.empty()) {
    crash_ = judge_contacts(*world_, body_id_, motion_.before(), params_);
    if (crash_.empty() && foliage_.touches(world_->scene(), body(), dt.s())) {
      crash_ = fmt::format("touched the canopy at {:.1f} m/s", body().v_WB_W.norm());
    }
  }
  if (!news_.empty() && event_writer_.connected()) {
    event_writer_.write(now, news_.front());
    news_.erase(news_.begin());
  }
}

void Quadrotor::read_truth(Odometry& truth) const {
  const Quaterniond q_BW = body().X_WB.q.conjugate();
  truth.X_WB = body().X_WB;
  truth.v_WB_B = q_BW * body().v_WB_W;
  truth.w_WB_B = q_BW * body().w_WB_W;
}

Vector3d Quadrotor::air_velocity_B() const {
  return body().X_WB.q.conjugate() * (body().v_WB_W - wind_W_);
}

void Quadrotor::read_links(std::vector<Pose>& X_WL) const {
  X_WL[0] = body().X_WB;
  for (std::size_t i = 0; i < kRotors; ++i) {
    const Eigen::AngleAxisd turn(rotors_[i].angle_rad, Vector3d::UnitZ());
    X_WL[1 + i] = body().X_WB * Pose{Quaterniond(turn), hubs_B_[i]};
  }
}

void Quadrotor::connect(Ports& ports) {
  rotors_writer_ = ports.write<NamedValues>("rotors");
  battery_writer_ = ports.write<BatteryState>("battery");
  event_writer_ = ports.write<Event>("vehicle_event");
}

void Quadrotor::publish(Time now) {
  std::size_t k = 0;
  for (const RotorState& rotor : rotors_) {
    rotors_message_.values[k++] = rotor.speed_radps;
    rotors_message_.values[k++] = rotor.thrust_N;
  }
  for (int axis = 0; axis < 3; ++axis) rotors_message_.values[k++] = wind_W_[axis];
  if (rotors_writer_.connected()) rotors_writer_.write(now, rotors_message_);
  if (battery_writer_.connected()) battery_writer_.write(now, battery_);
}

std::unique_ptr<Vehicle> make_quadrotor(const ParameterSet& parameters,
                                        const VehicleContext& context) {
  return std::make_unique<Quadrotor>(
      read_quadrotor_params(parameters, context.vehicle, context.gravity_mps2), context,
      LinkShelf(parameters, context));
}

}  // namespace vinerow::vehicles
