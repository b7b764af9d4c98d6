#pragma once
/// Mechanics of ground vehicles: a rigid body on three or more wheels (wheel.h), with a battery. A
/// vehicle class adds its actuators, meshes and parameters.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/vehicle.h"
#include "engine/physics/physics_world.h"
#include "vehicles/parts/air_drag.h"
#include "vehicles/parts/battery.h"
#include "vehicles/parts/wheel.h"
#include "vehicles/parts/wind_probe.h"

namespace vinerow::vehicles {

struct WheeledPlatformParams {
  std::string name;      ///< of the vehicle, for contacts and errors
  double mass_kg = 0.0;  ///< wheels included
  Eigen::Matrix3d inertia_B = Eigen::Matrix3d::Identity();  ///< about B, wheels included, kg m2
  std::vector<physics::PlacedShape> shapes;
  std::vector<WheelParams> wheels;  ///< at least 3, around B
  BatteryParams battery;
  AirDragParams air;          ///< default: no drag, so that wind has no effect
  double com_height_m = 0.0;  ///< of B above level ground, for the wind's lever

  /// @throws ConfigError
  void validate() const;
};

/// Static load of each wheel on level ground, N: equilibrium of force and moment, least squares
/// with more than three wheels. @param hubs_B  positions relative to the centre of mass
/// @returns empty if the centre of mass is outside the wheels
std::vector<double> calc_static_loads(std::span<const Eigen::Vector3d> hubs_B, double weight_N);

struct WheeledPlatformState {
  physics::BodyState body;         ///< as of the last step
  std::vector<WheelState> wheels;  ///< same order as the params
  BatteryState battery;
  bool powered = true;  ///< false for good once the battery is empty
  Eigen::Vector3d specific_force_B = Eigen::Vector3d::Zero();
};

class WheeledPlatform {
 public:
  /// @throws ConfigError
  explicit WheeledPlatform(WheeledPlatformParams params);

  /// Enables wind forces if the params have a drag area and the world is not calm. Before spawn().
  /// @param random  the vehicle's own stream for turbulence
  void feel_wind(RandomStream random) { wind_random_ = random; }
  /// Places it at rest, with loaded struts and tyres (static_rest.h).
  /// @throws ConfigError as validate(Wind)
  void spawn(physics::PhysicsWorld& world, const Pose& X_WB);
  /// Starts in motion: rolls without slip at this forward speed from the next step on.
  void set_forward_speed(double v_mps);
  /// @param wheel  index
  /// @param speed_radps  commanded spin; exactly 0 allows the parking brake to close
  void command_speed(std::size_t wheel, double speed_radps) { commands_[wheel] = speed_radps; }
  /// Sets the angle of the axle about the strut at once; the vehicle models any lag.
  void set_steer(std::size_t wheel, double steer_rad) {
    state_.wheels[wheel].steer_rad = steer_rad;
  }

  /// Applies the wind's force over the coming step; called together with before_physics().
  /// @param now  start of the step
  void push_by_wind(Time now, Duration dt);
  void before_physics(Duration dt);
  void after_physics(Duration dt);

  void read_truth(Odometry& truth) const;
  /// Signals "wheels" (NamedValues) and "battery".
  void connect(Ports& ports);
  void publish(Time now);

  const WheeledPlatformParams& params() const { return params_; }
  const WheeledPlatformState& state() const { return state_; }
  std::span<const WheelOutput> outputs() const { return outputs_; }
  /// Null without wind forces.
  const WindProbe* wind() const { return wind_ ? &*wind_ : nullptr; }
  const Wheel& wheel(std::size_t index) const { return wheels_[index]; }
  physics::BodyId body() const { return body_; }

 private:
  void come_to_rest();

  WheeledPlatformParams params_;
  std::vector<Wheel> wheels_;
  WheeledPlatformState state_;
  std::optional<RandomStream> wind_random_;
  std::optional<WindProbe> wind_;
  std::vector<double> commands_;
  std::vector<WheelOutput> outputs_;
  physics::PhysicsWorld* world_ = nullptr;
  physics::BodyId body_;
  NamedValues wheels_message_;
  SignalWriter<NamedValues> wheels_writer_;
  SignalWriter<BatteryState> battery_writer_;
};

/// Names of a wheel's published values.
std::vector<std::string> wheel_value_names(const std::string& wheel_name);
constexpr std::size_t kWheelValues = 8;

}  // namespace vinerow::vehicles
