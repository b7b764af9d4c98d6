#include "vehicles/parts/air_drag.h"

#include "engine/api/parameter_table.h"

namespace vinerow::vehicles {

void AirDragParams::validate(const std::string& name) const {
  air_drag_table().validate(*this, name);
}

const ParameterTable<AirDragParams>& air_drag_table() {
  using P = AirDragParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("drag_area_m2", "m2", &P::drag_area_m2, between(0.0, 1e3),
                  "drag coefficient times frontal area, in wind only; 0: no wind force")
          .number("side_drag_area_m2", "m2", &P::side_drag_area_m2, between(0.0, 1e3),
                  "the same from the side; default: drag_area_m2")
          .number("pressure_centre_height_m", "m", &P::pressure_height_m, between(0.0, 100.0),
                  "height of the wind force's point of action above level ground; default: the "
                  "centre of mass");
  return table;
}

Eigen::Vector3d calc_air_drag_B(const AirDragParams& params, double air_density_kgm3,
                                const Eigen::Vector3d& air_B) {
  const double half_rho_v = 0.5 * air_density_kgm3 * air_B.head<2>().norm();
  return {half_rho_v * params.drag_area_m2 * air_B.x(),
          half_rho_v * params.side_area_m2() * air_B.y(), 0.0};
}

}  // namespace vinerow::vehicles
