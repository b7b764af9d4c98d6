#pragma once
/// Chassis with four equal driven wheels at the corners of a rectangle and the centre of mass above
/// its middle: values, scenario parameters, mechanics and wheel links.

#include <array>
#include <string>
#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "engine/api/vehicle.h"
#include "vehicles/parts/air_drag.h"
#include "vehicles/parts/wheel_mesh.h"
#include "vehicles/parts/wheeled_platform.h"

namespace vinerow::vehicles {

/// Corner of the chassis: name of the wheel, and the signs of its x and y.
struct Corner {
  const char* name;
  double along;
  double across;
};
/// Front left, front right, rear left, rear right. Wheels always have this order.
inline constexpr std::array<Corner, 4> kCorners = {
    {{"fl", 1.0, 1.0}, {"fr", 1.0, -1.0}, {"rl", -1.0, 1.0}, {"rr", -1.0, -1.0}}};

/// Defaults: paper B's rover. Sources: assets/vehicles/rover_paper_b.yaml.
struct ChassisParams {
  std::string name = "rover";
  double wheel_base_m = 1.5;
  double track_m = 1.0;
  double wheel_radius_m = 0.2;
  double tyre_width_m = 0.16;
  double wheel_speed_limit_radps = 20.0;              ///< of the actuators
  double mass_kg = 180.0;                             ///< wheels included
  double com_height_m = 0.38;                         ///< of B above level ground
  Eigen::Vector3d inertia_kgm2 = {21.0, 56.0, 70.0};  ///< about B's axes
  double wheel_inertia_kgm2 = 0.28;                   ///< about the axle, gear and rotor included
  double suspension_stiffness_N_per_m = 20000.0;
  double suspension_damping_Ns_per_m = 1000.0;
  int wheel_probes = 3;
  MotorParams motor{.max_power_W = 1200.0};
  TyreParams tyre;
  BatteryParams battery;
  AirDragParams air;  ///< default: no drag, so that wind has no effect

  /// Centre of a wheel in B, as drawn.
  Eigen::Vector3d hub_B(const Corner& corner) const;
};

/// Table of sizes, masses and springs, then motor, tyre, battery and air drag. A vehicle whose
/// parameters derive from ChassisParams includes it with chassis_of.
const ParameterTable<ChassisParams>& chassis_table();
inline constexpr auto chassis_of = [](auto& params) -> ChassisParams& { return params; };

/// Body, wheels and battery, without collision shapes.
WheeledPlatformParams chassis_platform_params(const ChassisParams& params, double gravity_mps2);

/// Sets mass, height above the ground, `wheeled` and a collision box around chassis and wheels, and
/// appends the actuators "wheel_<name>_speed_radps" of the corners, forward and backward.
/// @param hull_bottom_m, hull_top_m  of the box above level ground
void describe_chassis(const ChassisParams& params, double hull_bottom_m, double hull_top_m,
                      VehicleDescription& description);

/// Appends four links "wheel_<name>" in the order of the corners.
/// @param wheel  its `left` is ignored and set for each wheel
void append_wheel_links(WheelMeshParams wheel, const Material& material,
                        std::vector<VehicleLink>& out);

}  // namespace vinerow::vehicles
