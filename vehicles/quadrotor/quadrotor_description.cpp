#include <fmt/format.h>

#include "vehicles/quadrotor/quadrotor.h"
#include "vehicles/quadrotor/quadrotor_mesh.h"
#include "vehicles/quadrotor/quadrotor_shapes.h"

namespace vinerow::vehicles {

void Quadrotor::describe() {
  const QuadrotorParams& p = params_;
  description_.type = "quadrotor";
  description_.mass_kg = p.mass_kg;
  description_.height_above_ground_m = p.stand_height_m;
  describe_outline(p, description_);
  description_.max_speed_mps = p.max_speed_mps;
  description_.min_turning_radius_m = p.min_turning_radius_m;
  description_.battery_capacity_J = p.battery.capacity_Wh * 3600.0;
  Rotorcraft& craft = description_.rotorcraft.emplace();
  craft.inertia_kgm2 = p.inertia_kgm2;
  craft.thrust_coefficient_Ns2 = p.rotor.thrust_coefficient_Ns2;
  craft.torque_coefficient_Nms2 = p.rotor.torque_coefficient_Nms2;
  craft.max_rotor_radps = p.rotor.max_radps;
  craft.rotor_lag_s = p.rotor.rise_lag_s;
  craft.rotor_inertia_kgm2 = p.rotor.inertia_kgm2;
  craft.rotor_drag_Ns_per_m = p.rotor_drag_Ns_per_m;
  craft.rotor_radius_m = p.rotor_radius_m;
  craft.tip_radius_m = p.arm_m + p.rotor_radius_m;
  craft.max_tilt_rad = p.max_tilt_rad;
  craft.landing_speed_limit_mps = p.landing_speed_limit_mps;
  for (std::size_t i = 0; i < kRotors; ++i) {
    description_.actuators.push_back(
        {fmt::format("rotor_{}_speed_radps", i + 1), "rad/s", 0.0, p.rotor.max_radps});
    craft.rotors.push_back({p.hub_B(i).head<2>(), QuadrotorParams::torque_sign(i)});
  }
}

void Quadrotor::describe_air(double density_ratio) {
  Rotorcraft& craft = *description_.rotorcraft;
  craft.thrust_coefficient_Ns2 = density_ratio * params_.rotor.thrust_coefficient_Ns2;
  craft.torque_coefficient_Nms2 = density_ratio * params_.rotor.torque_coefficient_Nms2;
}

std::vector<VehicleLink> Quadrotor::make_links() const {
  std::vector<VehicleLink> links;
  Material material;
  material.name = "quadrotor";
  material.colour = {1.0f, 1.0f, 1.0f};  // the meshes carry their colours
  material.roughness = 0.5f;
  links.push_back({"body", std::make_shared<TriangleMesh>(make_quadrotor_body(params_)), material});
  // Rotors that turn opposite ways are each other's mirror image.
  for (std::size_t i = 0; i < kRotors; ++i) {
    const bool counter_clockwise = QuadrotorParams::torque_sign(i) < 0.0;
    links.push_back({fmt::format("rotor_{}", i + 1),
                     std::make_shared<TriangleMesh>(
                         make_quadrotor_rotor(params_.rotor_radius_m, counter_clockwise)),
                     material});
  }
  return links;
}

}  // namespace vinerow::vehicles
