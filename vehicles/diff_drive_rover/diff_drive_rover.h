#pragma once
/// Rover of paper B: four driven wheels and skid steering, with wheel and tyre forces.
///
/// Actuators: wheel_fl_speed_radps, wheel_fr_..., wheel_rl_..., wheel_rr_..., positive forward.
/// Signals: "wheels" (NamedValues), "battery". B: centre of mass, in the middle between the wheels,
/// com_height_m above level ground.

#include <memory>

#include "engine/api/registry.h"
#include "vehicles/diff_drive_rover/diff_drive_rover_params.h"
#include "vehicles/parts/link_shelf.h"
#include "vehicles/parts/platform_vehicle.h"

namespace vinerow::vehicles {

class DiffDriveRover final : public PlatformVehicle {
 public:
  /// @throws ConfigError
  explicit DiffDriveRover(const DiffDriveRoverParams& params, double gravity_mps2 = 9.80665,
                          const LinkShelf& links = {});
};

/// Description with the effective track of a skid-steered rover on tyres.
VehicleDescription describe_diff_drive_rover(const DiffDriveRoverParams& params);
/// The collision box of the description.
physics::PlacedShape make_diff_drive_shape(const VehicleDescription& description);
/// Body and wheels.
std::vector<VehicleLink> make_diff_drive_links(const DiffDriveRoverParams& params);

/// A DiffDriveRover, or a KinematicRover with `fidelity: kinematic`. @throws ConfigError
std::unique_ptr<Vehicle> make_diff_drive_rover(const ParameterSet& parameters,
                                               const VehicleContext& context);

}  // namespace vinerow::vehicles
