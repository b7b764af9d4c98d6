#pragma once
/// Electric rover of paper A: an Ackermann mechanism on both axles, a hub motor in each wheel.
///
/// Actuators: axle_front_steer_rad, axle_rear_steer_rad (bicycle angle of each axle, positive to
/// the left), wheel_fl_speed_radps, ..._fr_, ..._rl_, ..._rr_ (positive forward). The directions of
/// the wheels follow from both axle angles (parts/double_ackermann.h), which servos with a lag and
/// a rate limit set. Wheel speeds are commanded one by one, so that inconsistent commands make the
/// wheels work against each other. Signals: "wheels" (NamedValues), "battery".
///
/// Motions: straight; crab (equal axle angles, to max_axle_steer_rad); two-wheel steering (one axle
/// at 0); and double Ackermann (opposite axle angles), the tightest turn, with
/// min_turning_radius_m about a point beside B. A turn on the spot would need wheels at right
/// angles to their levers (60 deg here), beyond the steering range: "pivot-like" means the double
/// Ackermann turn.
///
/// B: centre of mass, in the middle between the wheels, com_height_m above level ground.

#include <memory>

#include "engine/api/registry.h"
#include "vehicles/four_wheel_steering_rover/four_wheel_steering_rover_params.h"
#include "vehicles/parts/link_shelf.h"
#include "vehicles/parts/steered_platform_vehicle.h"

namespace vinerow::vehicles {

class FourWheelSteeringRover final : public SteeredPlatformVehicle {
 public:
  /// @throws ConfigError
  explicit FourWheelSteeringRover(const FourWheelSteeringRoverParams& params,
                                  double gravity_mps2 = 9.80665, const LinkShelf& links = {});

 private:
  void describe();
  std::vector<VehicleLink> make_links() const;

  FourWheelSteeringRoverParams params_;
};

std::unique_ptr<Vehicle> make_four_wheel_steering_rover(const ParameterSet& parameters,
                                                        const VehicleContext& context);

}  // namespace vinerow::vehicles
