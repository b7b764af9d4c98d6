#include "vehicles/parts/platform_vehicle.h"

#include <numeric>

#include "engine/core/check.h"

namespace vinerow::vehicles {

void PlatformVehicle::build_platform(WheeledPlatformParams params,
                                     std::vector<std::size_t> driven) {
  platform_.emplace(std::move(params));
  driven_ = std::move(driven);
  if (driven_.empty()) {
    driven_.resize(platform_->state().wheels.size());
    std::iota(driven_.begin(), driven_.end(), std::size_t{0});
  }
  actuator_states_.assign(description_.actuators.size(), 0.0);
}

void PlatformVehicle::spawn(physics::PhysicsWorld& world, const Pose& X_WB) {
  platform_->spawn(world, X_WB);
}

void PlatformVehicle::connect(Ports& ports) {
  platform_->connect(ports);
  event_writer_ = ports.write<Event>("vehicle_event");
}

void PlatformVehicle::actuate(std::span<const double> values) {
  VINEROW_ASSERT(values.size() == driven_.size());
  for (std::size_t i = 0; i < values.size(); ++i) platform_->command_speed(driven_[i], values[i]);
}

void PlatformVehicle::before_physics(Time now, Duration dt) {
  platform_->push_by_wind(now, dt);
  platform_->before_physics(dt);
}

void PlatformVehicle::after_physics(Time now, Duration dt) {
  platform_->after_physics(dt);
  if (!platform_->state().powered && !reported_empty_) {
    reported_empty_ = true;
    report_empty_battery(now, platform_->params().name, event_writer_);
  }
  const std::vector<WheelState>& wheels = platform_->state().wheels;
  // Wheel speeds are the last actuators; what stands before them is the vehicle's own.
  const std::size_t first = actuator_states_.size() - driven_.size();
  for (std::size_t i = 0; i < driven_.size(); ++i) {
    actuator_states_[first + i] = wheels[driven_[i]].spin_radps;
  }
}

void PlatformVehicle::read_truth(Odometry& truth) const {
  platform_->read_truth(truth);
}

Eigen::Vector3d PlatformVehicle::specific_force_B() const {
  return platform_->state().specific_force_B;
}

Eigen::Vector3d PlatformVehicle::air_velocity_B() const {
  const physics::BodyState& body = platform_->state().body;
  Eigen::Vector3d air_W = body.v_WB_W;
  if (const WindProbe* wind = platform_->wind()) air_W -= wind->wind_W();
  return body.X_WB.q.conjugate() * air_W;
}

void PlatformVehicle::read_links(std::vector<Pose>& X_WL) const {
  const WheeledPlatformState& state = platform_->state();
  X_WL[0] = state.body.X_WB;
  for (std::size_t i = 0; i < state.wheels.size(); ++i) {
    X_WL[i + 1] = state.body.X_WB * platform_->wheel(i).link_pose_B(state.wheels[i]);
  }
}

void PlatformVehicle::publish(Time now) {
  platform_->publish(now);
  if (note_.empty() || !event_writer_.connected()) return;
  event_writer_.write(now, {Event::Level::kWarning, platform_->params().name, note_});
  note_.clear();
}

}  // namespace vinerow::vehicles
