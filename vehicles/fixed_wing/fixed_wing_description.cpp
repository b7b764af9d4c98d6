#include <cmath>

#include "vehicles/fixed_wing/fixed_wing.h"
#include "vehicles/fixed_wing/fixed_wing_mesh.h"
#include "vehicles/fixed_wing/fixed_wing_shapes.h"

namespace vinerow::vehicles {

void FixedWing::describe() {
  const FixedWingParams& p = params_;
  description_.type = "fixed_wing";
  description_.mass_kg = p.mass_kg;
  description_.height_above_ground_m = p.shape.belly_m;
  describe_outline(p, description_);
  const double limit_rad = p.elevon_limit_rad;
  description_.actuators = {{"throttle", "", 0.0, 1.0},
                            {"elevon_left_rad", "rad", -limit_rad, limit_rad},
                            {"elevon_right_rad", "rad", -limit_rad, limit_rad}};
  const double v = p.cruise_speed_mps;
  description_.max_speed_mps = p.max_speed_mps;
  description_.min_turning_radius_m = v * v / (gravity_mps2_ * std::tan(p.max_bank_rad));
  description_.battery_capacity_J = p.battery.capacity_Wh * 3600.0;
  FixedWingAircraft& aircraft = description_.fixed_wing.emplace();
  aircraft.flight_model = model_;
  aircraft.span_m = p.wing.span_m;
  aircraft.wing_area_m2 = p.wing.area_m2;
  aircraft.cruise_speed_mps = v;
  aircraft.stall_speed_mps = p.stall_speed_mps(gravity_mps2_);
  aircraft.max_bank_rad = p.max_bank_rad;
  aircraft.throttle_lag_s = p.propeller.lag_s;
  aircraft.elevon_lag_s = p.elevon_lag_s;
  aircraft.launch_throttle = p.launch.throttle;
  aircraft.landing_sink_limit_mps = p.landing_sink_limit_mps;
  aircraft.belly_height_m = p.shape.belly_m;
  aircraft.start_height_m =
      p.launch.mode == LaunchMode::kAir ? p.launch.start_height_m : p.launch.height_m;
}

void FixedWing::describe_air(double density_kgm3) {
  FixedWingAircraft& aircraft = *description_.fixed_wing;
  // Lift goes with density times speed squared.
  const double ratio = aircraft.air_density_kgm3 / density_kgm3;
  if (ratio != 1.0) aircraft.stall_speed_mps *= std::sqrt(ratio);
  aircraft.air_density_kgm3 = density_kgm3;
}

std::vector<VehicleLink> FixedWing::make_links() const {
  std::vector<VehicleLink> links;
  Material material;
  material.name = "fixed_wing";
  material.colour = {1.0f, 1.0f, 1.0f};  // the meshes carry their colours
  material.roughness = 0.5f;
  const auto add = [&](const char* name, TriangleMesh mesh) {
    links.push_back({name, std::make_shared<TriangleMesh>(std::move(mesh)), material});
  };
  add("body", make_fixed_wing_body(params_));
  add("elevon_left", make_fixed_wing_elevon(params_, 1.0));
  add("elevon_right", make_fixed_wing_elevon(params_, -1.0));
  add("propeller", make_fixed_wing_propeller(params_));
  return links;
}

}  // namespace vinerow::vehicles
