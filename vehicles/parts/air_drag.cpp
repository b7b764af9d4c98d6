#include "vehicles/parts/air_drag.h"

#include "vehicles/parts/validation.h"

namespace vinerow::vehicles {

void AirDragParams::validate(const std::string& name) const {
  demand_not_negative(name, "drag_area_m2", drag_area_m2);
  demand_not_negative(name, "side_drag_area_m2", side_drag_area_m2);
  demand_not_negative(name, "pressure_centre_height_m", pressure_height_m.value_or(0.0));
}

std::vector<ParameterSpec> air_drag_parameter_specs() {
  return {number_parameter("drag_area_m2", "m2", 0.0, 0.0, 1e3,
                           "drag coefficient times frontal area, in wind only; 0: wind does not "
                           "push"),
          optional(number_parameter("side_drag_area_m2", "m2", 0.0, 0.0, 1e3,
                                    "the same from the side; default: drag_area_m2")),
          optional(number_parameter("pressure_centre_height_m", "m", 0.0, 0.0, 100.0,
                                    "where the wind's force acts, above level ground; default: "
                                    "the centre of mass"))};
}

AirDragParams read_air_drag_params(const ParameterSet& parameters) {
  AirDragParams air;
  air.drag_area_m2 = parameters.number("drag_area_m2");
  air.side_drag_area_m2 = parameters.has("side_drag_area_m2")
                              ? parameters.number("side_drag_area_m2")
                              : air.drag_area_m2;
  if (parameters.has("pressure_centre_height_m")) {
    air.pressure_height_m = parameters.number("pressure_centre_height_m");
  }
  return air;
}

Eigen::Vector3d calc_air_drag_B(const AirDragParams& params, double air_density_kgm3,
                                const Eigen::Vector3d& air_B) {
  const double half_rho_v = 0.5 * air_density_kgm3 * air_B.head<2>().norm();
  return {half_rho_v * params.drag_area_m2 * air_B.x(),
          half_rho_v * params.side_drag_area_m2 * air_B.y(), 0.0};
}

}  // namespace vinerow::vehicles
