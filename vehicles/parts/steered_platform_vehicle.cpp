#include "vehicles/parts/steered_platform_vehicle.h"

#include <fmt/format.h>

#include "engine/core/check.h"

namespace vinerow::vehicles {

void SteeredPlatformVehicle::build_steering(SteeringGear gear) {
  VINEROW_DEMAND(description_.actuators.empty());
  gear_ = std::move(gear);
  constexpr std::array<const char*, 2> kAxles = {"front", "rear"};
  for (std::size_t axle = 0; axle < gear_.steered_axles; ++axle) {
    description_.actuators.push_back({fmt::format("axle_{}_steer_rad", kAxles[axle]), "rad",
                                      -gear_.max_axle_steer_rad, gear_.max_axle_steer_rad});
  }
  if (gear_.steered_axles == 2) {
    description_.steered = SteeredVehicle{.front_axle_m = gear_.axles.front_m,
                                          .rear_axle_m = gear_.axles.rear_m,
                                          .max_axle_steer_rad = gear_.max_axle_steer_rad,
                                          .steer_rate_radps = gear_.servo.rate_radps,
                                          .steer_lag_s = gear_.servo.lag_s};
  } else if (gear_.steered_axles == 1) {
    description_.ackermann = AckermannVehicle{.rear_axle_m = gear_.axles.rear_m,
                                              .max_axle_steer_rad = gear_.max_axle_steer_rad,
                                              .steer_rate_radps = gear_.servo.rate_radps,
                                              .steer_lag_s = gear_.servo.lag_s};
  }
}

void SteeredPlatformVehicle::actuate(std::span<const double> values) {
  const std::size_t axles = gear_.steered_axles;
  VINEROW_ASSERT(values.size() == axles + driven_.size());
  for (std::size_t axle = 0; axle < axles; ++axle) command_rad_[axle] = values[axle];
  PlatformVehicle::actuate(values.subspan(axles));
}

void SteeredPlatformVehicle::steer(double dt_s) {
  bool moved = false;
  std::array<double, 2> angles_rad{};
  for (std::size_t axle = 0; axle < gear_.steered_axles; ++axle) {
    double& angle_rad = actuator_states_[axle];
    if (command_rad_[axle] != angle_rad) {
      angle_rad = advance_servo(gear_.servo, command_rad_[axle], dt_s, angle_rad);
      moved = true;
    }
    angles_rad[axle] = angle_rad;
  }
  if (!moved) return;
  const std::array<double, 4> wheels_rad =
      calc_wheel_angles(gear_.axles, angles_rad[0], angles_rad[1]);
  for (std::size_t i = 0; i < wheels_rad.size(); ++i) {
    platform_->set_steer(gear_.wheels[i], wheels_rad[i]);
  }
}

void SteeredPlatformVehicle::before_physics(Time now, Duration dt) {
  if (platform_->state().powered) steer(dt.s());
  PlatformVehicle::before_physics(now, dt);
}

void SteeredPlatformVehicle::read_links(std::vector<Pose>& X_WL) const {
  PlatformVehicle::read_links(X_WL);
  const WheeledPlatformState& state = platform_->state();
  const std::size_t first = 1 + state.wheels.size();
  for (std::size_t i = 0; i < gear_.knuckles.size(); ++i) {
    WheelState unturned = state.wheels[gear_.knuckles[i]];
    unturned.angle_rad = 0.0;
    X_WL[first + i] = state.body.X_WB * platform_->wheel(gear_.knuckles[i]).link_pose_B(unturned);
  }
}

}  // namespace vinerow::vehicles
