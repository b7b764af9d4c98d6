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
  description_.numbers = {
      {"rotor_count", static_cast<double>(kRotors)},
      {"rotor_thrust_coefficient", p.rotor.thrust_coefficient_Ns2},
      {"rotor_torque_coefficient", p.rotor.torque_coefficient_Nms2},
      {"rotor_min_radps", 0.0},
      {"rotor_max_radps", p.rotor.max_radps},
      {"rotor_lag_s", p.rotor.rise_lag_s},
      {"rotor_drag_Ns_per_m", p.rotor_drag_Ns_per_m},
      {"rotor_radius_m", p.rotor_radius_m},
      {"tip_radius_m", p.arm_m + p.rotor_radius_m},
      {"inertia_xx_kgm2", p.inertia_kgm2.x()},
      {"inertia_yy_kgm2", p.inertia_kgm2.y()},
      {"inertia_zz_kgm2", p.inertia_kgm2.z()},
      {"rotor_inertia_kgm2", p.rotor.inertia_kgm2},
      {"max_tilt_rad", p.max_tilt_rad},
      {"max_speed_mps", p.max_speed_mps},
      {"min_turning_radius_m", p.min_turning_radius_m},
      {"landing_speed_limit_mps", p.landing_speed_limit_mps},
      {"battery_capacity_J", p.battery.capacity_Wh * 3600.0},
  };
  for (std::size_t i = 0; i < kRotors; ++i) {
    const std::string rotor = fmt::format("rotor_{}", i + 1);
    description_.actuators.push_back({rotor + "_speed_radps", "rad/s", 0.0, p.rotor.max_radps});
    description_.numbers[rotor + "_x_m"] = p.hub_B(i).x();
    description_.numbers[rotor + "_y_m"] = p.hub_B(i).y();
    description_.numbers[rotor + "_torque_sign"] = QuadrotorParams::torque_sign(i);
  }
}

void Quadrotor::make_links() {
  Material material;
  material.name = "quadrotor";
  material.colour = {1.0f, 1.0f, 1.0f};  // the meshes carry their colours
  material.roughness = 0.5f;
  links_.push_back(
      {"body", std::make_shared<TriangleMesh>(make_quadrotor_body(params_)), material});
  // Rotors that turn opposite ways are each other's mirror image.
  for (std::size_t i = 0; i < kRotors; ++i) {
    const bool counter_clockwise = QuadrotorParams::torque_sign(i) < 0.0;
    links_.push_back({fmt::format("rotor_{}", i + 1),
                      std::make_shared<TriangleMesh>(
                          make_quadrotor_rotor(params_.rotor_radius_m, counter_clockwise)),
                      material});
  }
}

}  // namespace vinerow::vehicles
