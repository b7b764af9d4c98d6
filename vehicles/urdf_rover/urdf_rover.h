#pragma once
/// Wheeled robot from a URDF file, with the wheel model of parts/wheel.h and the file's masses. It
/// steers by wheel speeds (skid steering), by its front wheels (Ackermann), or by all four.
///
/// A wheel steers if it is attached to a joint about the vertical through its hub, or to a joint
/// that is named. The wheels of a steered axle then have the angles of an Ackermann mechanism,
/// whatever linkage or servos the robot has. Each driven wheel has its own motor.
///
/// Actuators: for steered robots axle_front_steer_rad and, with four steered wheels,
/// axle_rear_steer_rad (of one wheel in the middle of the axle, positive to the left); then
/// wheel_<name>_speed_radps for each driven wheel, positive forward whatever the sign of
/// the joint's axis. Names are fl, fr, rl, rr with two wheels per side, else l1.., r1... Signals:
/// "wheels", "battery". B: centre of mass of the whole robot, axes of the root link.

#include <memory>

#include "engine/api/registry.h"
#include "vehicles/parts/steered_platform_vehicle.h"
#include "vehicles/urdf_rover/urdf_rover_model.h"

namespace vinerow::vehicles {

enum class DrivenWheels { kAuto, kAll, kRear };

struct UrdfRoverParams {
  std::string name = "rover";
  std::filesystem::path urdf;
  std::vector<std::string> packages;  ///< folders of package:// names, "name=folder" each
  UrdfRoverOptions options;
  std::optional<double> max_steer_rad;  ///< of a wheel; absent: the joints' limits
  SteeringServoParams servo;
  DrivenWheels driven = DrivenWheels::kAuto;  ///< auto: the rear ones of an Ackermann robot
  double max_speed_mps = 1.0;
  double min_turning_radius_m = 0.5;
  double wheel_speed_limit_radps = 10.0;
  double static_deflection_m = 0.008;  ///< of the wheels' springs under the robot's weight
  double damping_ratio = 0.5;          ///< of the heave on them
  int wheel_probes = 3;
  /// Values of a 50 kg class robot; sources in assets/vehicles/husky.yaml.
  MotorParams motor{.max_torque_Nm = 40.0,
                    .max_power_W = 200.0,
                    .max_speed_radps = 12.0,
                    .speed_gain_Nms = 15.0,
                    .speed_integral_gain_Nm = 80.0,
                    .brake_torque_Nm = 40.0};
  TyreParams tyre;
  BatteryParams battery{480.0, 20.0};
  AirDragParams air;

  /// @throws ConfigError
  void validate() const;
  /// Folders by name; relative paths are relative to the URDF file.
  std::map<std::string, std::filesystem::path> package_folders() const;
};

PartSpec urdf_rover_spec();
UrdfRoverParams read_urdf_rover_params(const ParameterSet& parameters, const std::string& name);

class UrdfRover final : public SteeredPlatformVehicle {
 public:
  /// @param shelf  cache for the file and its meshes; null: none. @throws ConfigError
  explicit UrdfRover(const UrdfRoverParams& params, double gravity_mps2 = 9.80665,
                     FileShelf* shelf = nullptr);

  const UrdfRoverModel& model() const { return model_; }

 private:
  void describe(const UrdfRoverParams& params);
  /// Sets up the steering. @throws ConfigError without a limit of the angle
  void describe_steering(const UrdfRoverParams& params);

  UrdfRoverModel model_;
  std::vector<std::size_t> driven_wheels_;  ///< indices in the model
};

std::unique_ptr<Vehicle> make_urdf_rover(const ParameterSet& parameters,
                                         const VehicleContext& context);

}  // namespace vinerow::vehicles
