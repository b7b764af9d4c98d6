#pragma once
/// Any skid-steered robot from a URDF file, on the shared wheel, with the file's own masses.
///
/// Actuators: wheel_<name>_speed_radps for each wheel joint, positive forward whatever the sign of
/// the joint's axis; names fl, fr, rl, rr with two wheels a side, else l1.., r1... Signals:
/// "wheels", "battery". B: centre of mass of the whole robot, axes of the root link.

#include <memory>

#include "engine/api/registry.h"
#include "vehicles/parts/platform_vehicle.h"
#include "vehicles/urdf_rover/urdf_rover_model.h"

namespace vinerow::vehicles {

struct UrdfRoverParams {
  std::string name = "rover";
  std::filesystem::path urdf;
  std::vector<std::string> packages;  ///< folders of package:// names, "name=folder" each
  UrdfRoverOptions options;
  double max_speed_mps = 1.0;
  double min_turning_radius_m = 0.5;
  double wheel_speed_limit_radps = 10.0;
  double static_deflection_m = 0.008;  ///< of the wheels' springs under the robot's weight
  double damping_ratio = 0.5;          ///< of the heave on them
  int wheel_probes = 3;
  /// Of a 50 kg class robot; sources in assets/vehicles/husky.yaml.
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
  /// The folders by their names, relative ones to the URDF file.
  std::map<std::string, std::filesystem::path> package_folders() const;
};

PartSpec urdf_rover_spec();
UrdfRoverParams read_urdf_rover_params(const ParameterSet& parameters, const std::string& name);

class UrdfRover final : public PlatformVehicle {
 public:
  /// @param shelf  where the file and its meshes are kept; null: nowhere. @throws ConfigError
  explicit UrdfRover(const UrdfRoverParams& params, double gravity_mps2 = 9.80665,
                     FileShelf* shelf = nullptr);

  const UrdfRoverModel& model() const { return model_; }

 private:
  void describe(const UrdfRoverParams& params);

  UrdfRoverModel model_;
};

std::unique_ptr<Vehicle> make_urdf_rover(const ParameterSet& parameters,
                                         const VehicleContext& context);

}  // namespace vinerow::vehicles
