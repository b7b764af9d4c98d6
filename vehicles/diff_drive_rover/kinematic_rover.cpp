#include "vehicles/diff_drive_rover/kinematic_rover.h"

#include <algorithm>
#include <cmath>

#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/math/angles.h"
#include "vehicles/diff_drive_rover/diff_drive_rover.h"

namespace vinerow::vehicles {
namespace {

const DiffDriveRoverParams& checked(const DiffDriveRoverParams& params) {
  params.validate();
  return params;
}

KinematicPlatformParams platform_params(const DiffDriveRoverParams& params,
                                        const VehicleDescription& description) {
  return {.name = params.name,
          .mass_kg = params.mass_kg,
          .inertia_B = params.inertia_kgm2.asDiagonal(),
          .shapes = {make_diff_drive_shape(description)},
          .track_m = params.track_m,
          .wheel_base_m = params.wheel_base_m,
          .height_above_ground_m = params.com_height_m};
}

}  // namespace

KinematicRover::KinematicRover(const DiffDriveRoverParams& params, const LinkShelf& links)
    : params_(checked(params)),
      description_(describe_diff_drive_rover(params)),
      links_(links.get([&] { return make_diff_drive_links(params); })),
      platform_(platform_params(params, description_)) {
  description_.wheeled->effective_track_m = params.track_m;
  for (const ActuatorSpec& actuator : description_.actuators) {
    wheels_message_.names.push_back(actuator.name);
  }
  wheels_message_.values.assign(kCorners.size(), 0.0);
  battery_.charge = params_.battery.initial_charge;
}

void KinematicRover::spawn(physics::PhysicsWorld& world, const Pose& X_WB) {
  world_ = &world;
  platform_.spawn(world, X_WB);
}

void KinematicRover::connect(Ports& ports) {
  wheels_writer_ = ports.write<NamedValues>("wheels");
  battery_writer_ = ports.write<BatteryState>("battery");
  event_writer_ = ports.write<Event>("vehicle_event");
}

void KinematicRover::actuate(std::span<const double> values) {
  VINEROW_ASSERT(values.size() == kCorners.size());
  if (!powered_) return;
  std::copy(values.begin(), values.end(), wheels_message_.values.begin());
  platform_.command(0.5 * (values[0] + values[2]) * params_.wheel_radius_m,
                    0.5 * (values[1] + values[3]) * params_.wheel_radius_m);
}

void KinematicRover::before_physics(Time /*now*/, Duration dt) {
  if (powered_ && battery_.charge <= 0.0) {
    actuate(std::array<double, kCorners.size()>{});
    powered_ = false;
  }
  platform_.before_physics(dt);
  for (std::size_t i = 0; i < kCorners.size(); ++i) {
    angle_rad_[i] = wrap_angle(angle_rad_[i] + wheels_message_.values[i] * dt.s());
  }
  if (!powered_) {  // nothing runs any more
    battery_.power_W = 0.0;
    return;
  }
  const double resistance_N = world_->world_model().soil.rolling_resistance * params_.mass_kg *
                              world_->settings().gravity_mps2;
  const double drive_W = resistance_N * std::abs(platform_.state().planar.v_mps);
  advance_battery(params_.battery, drive_W / params_.motor.efficiency, dt.s(), battery_);
}

void KinematicRover::after_physics(Time now, Duration /*dt*/) {
  if (powered_ || reported_empty_) return;
  reported_empty_ = true;
  report_empty_battery(now, params_.name, event_writer_);
}

void KinematicRover::read_links(std::vector<Pose>& X_WL) const {
  X_WL[0] = platform_.state().body.X_WB;
  for (std::size_t i = 0; i < kCorners.size(); ++i) {
    const Eigen::AngleAxisd turned(angle_rad_[i], Eigen::Vector3d::UnitY());
    X_WL[i + 1] = X_WL[0] * Pose{Eigen::Quaterniond(turned), params_.hub_B(kCorners[i])};
  }
}

void KinematicRover::publish(Time now) {
  if (wheels_writer_.connected()) wheels_writer_.write(now, wheels_message_);
  if (battery_writer_.connected()) battery_writer_.write(now, battery_);
}

}  // namespace vinerow::vehicles
