#include "vehicles/parts/chassis.h"

#include <fmt/format.h>

#include "engine/api/parameter_table.h"
#include "vehicles/parts/moments_of_inertia.h"

namespace vinerow::vehicles {

Eigen::Vector3d ChassisParams::hub_B(const Corner& corner) const {
  return {0.5 * corner.along * wheel_base_m, 0.5 * corner.across * track_m,
          wheel_radius_m - com_height_m};
}

namespace {

std::string find_fault_in_chassis_inertia(const ChassisParams& p) {
  return find_fault_in_moments("inertia_kgm2", p.inertia_kgm2);
}

}  // namespace

const ParameterTable<ChassisParams>& chassis_table() {
  using P = ChassisParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("wheel_base_m", "m", &P::wheel_base_m, kPositive, "front to rear axle")
          .number("track_m", "m", &P::track_m, kPositive, "left to right wheel centre")
          .number("wheel_radius_m", "m", &P::wheel_radius_m, kPositive, "rolling radius")
          .number("tyre_width_m", "m", &P::tyre_width_m, kPositive,
                  "width of the tyre, in pictures and in the hull")
          .number("wheel_speed_limit_radps", "rad/s", &P::wheel_speed_limit_radps, kPositive,
                  "largest wheel speed command in both directions")
          .number("mass_kg", "kg", &P::mass_kg, kPositive, "wheels included")
          .number("com_height_m", "m", &P::com_height_m, kPositive,
                  "centre of mass above level ground")
          .numbers("inertia_kgm2", "kg m2", &P::inertia_kgm2, kPositive,
                   "moments about the body's x, y, z axes")
          .number("wheel_inertia_kgm2", "kg m2", &P::wheel_inertia_kgm2, kPositive,
                  "one wheel with gear and rotor about its axle")
          .number("suspension_stiffness_N_per_m", "N/m", &P::suspension_stiffness_N_per_m,
                  kPositive, "spring and tyre of one wheel in series")
          .number("suspension_damping_Ns_per_m", "N s/m", &P::suspension_damping_Ns_per_m,
                  between(0.0, 1e6), "damper of one wheel")
          .integer("wheel_probes", &P::wheel_probes, between(1, 3),
                   "ground rays per wheel and step on smooth ground: 1 or 3")
          .include(&P::motor, motor_table())
          .include(&P::tyre, tyre_table())
          .include(&P::battery, battery_table())
          .include(&P::air, air_drag_table())
          .rule(find_fault_in_chassis_inertia);
  return table;
}

WheeledPlatformParams chassis_platform_params(const ChassisParams& p, double gravity_mps2) {
  WheeledPlatformParams platform;
  platform.name = p.name;
  platform.mass_kg = p.mass_kg;
  platform.inertia_B = p.inertia_kgm2.asDiagonal();
  platform.battery = p.battery;
  platform.air = p.air;
  platform.com_height_m = p.com_height_m;
  for (const Corner& corner : kCorners) {
    WheelParams wheel;
    wheel.name = corner.name;
    wheel.hub_B = p.hub_B(corner);
    wheel.radius_m = p.wheel_radius_m;
    wheel.spin_inertia_kgm2 = p.wheel_inertia_kgm2;
    wheel.probes = p.wheel_probes;
    wheel.tyre = p.tyre;
    wheel.motor = p.motor;
    wheel.suspension.stiffness_N_per_m = p.suspension_stiffness_N_per_m;
    wheel.suspension.damping_Ns_per_m = p.suspension_damping_Ns_per_m;
    wheel.suspension.design_load_N = 0.25 * p.mass_kg * gravity_mps2;
    platform.wheels.push_back(wheel);
  }
  return platform;
}

void describe_chassis(const ChassisParams& p, double hull_bottom_m, double hull_top_m,
                      VehicleDescription& description) {
  WheeledVehicle& wheeled = description.wheeled.emplace();
  for (const Corner& corner : kCorners) {
    wheeled.wheels.push_back(
        {static_cast<int>(description.actuators.size()), p.hub_B(corner).head<2>()});
    description.actuators.push_back({fmt::format("wheel_{}_speed_radps", corner.name), "rad/s",
                                     -p.wheel_speed_limit_radps, p.wheel_speed_limit_radps});
  }
  description.mass_kg = p.mass_kg;
  description.battery_capacity_J = p.battery.capacity_Wh * 3600.0;
  description.height_above_ground_m = p.com_height_m;
  description.collision_half_extents_m = {0.5 * p.wheel_base_m + p.wheel_radius_m,
                                          0.5 * (p.track_m + p.tyre_width_m),
                                          0.5 * (hull_top_m - hull_bottom_m)};
  description.collision_centre_B = {0.0, 0.0, 0.5 * (hull_top_m + hull_bottom_m) - p.com_height_m};
  wheeled.track_m = p.track_m;
  wheeled.wheel_base_m = p.wheel_base_m;
  wheeled.wheel_radius_m = p.wheel_radius_m;
  wheeled.wheel_speed_limit_radps = p.wheel_speed_limit_radps;
}

void append_wheel_links(WheelMeshParams wheel, const Material& material,
                        std::vector<VehicleLink>& out) {
  wheel.left = true;
  const auto left = std::make_shared<TriangleMesh>(make_wheel_mesh(wheel));
  wheel.left = false;
  const auto right = std::make_shared<TriangleMesh>(make_wheel_mesh(wheel));
  for (const Corner& corner : kCorners) {
    out.push_back(
        {fmt::format("wheel_{}", corner.name), corner.across > 0.0 ? left : right, material});
  }
}

}  // namespace vinerow::vehicles
