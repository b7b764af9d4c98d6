#include "vehicles/register_vehicles.h"

#include "vehicles/diff_drive_rover/diff_drive_rover.h"
#include "vehicles/fixed_wing/fixed_wing.h"
#include "vehicles/four_wheel_steering_rover/four_wheel_steering_rover.h"
#include "vehicles/payloads/register_payloads.h"
#include "vehicles/quadrotor/quadrotor.h"
#include "vehicles/urdf_rover/urdf_rover.h"

namespace vinerow::vehicles {

void register_vehicles(Registry& registry) {
  registry.add_vehicle(diff_drive_rover_spec(), make_diff_drive_rover);
  registry.add_vehicle(fixed_wing_spec(), make_fixed_wing);
  registry.add_vehicle(four_wheel_steering_rover_spec(), make_four_wheel_steering_rover);
  registry.add_vehicle(quadrotor_spec(), make_quadrotor);
  registry.add_vehicle(urdf_rover_spec(), make_urdf_rover);
  register_payloads(registry);
}

}  // namespace vinerow::vehicles
