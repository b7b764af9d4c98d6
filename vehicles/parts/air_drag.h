#pragma once
/// Air drag of a ground vehicle's hull, along and across.
///
///   f_B = 1/2 rho |v| (A_x v_x, A_y v_y, 0)
///
/// with the velocity v of the air relative to the vehicle, in B's plane, and drag areas A = C_d
/// times area. The force acts at the centre of pressure. Left out are lift, a yaw moment beyond
/// that lever and the lee of other bodies. In a calm world there is no drag at all: at 2 m/s the
/// drag of still air on 1 m2 is 2.5 N, a fortieth of the rolling resistance of 180 kg on dry grass.

#include <Eigen/Core>
#include <optional>
#include <string>

#include "engine/api/parameter_table_fwd.h"

namespace vinerow::vehicles {

struct AirDragParams {
  double drag_area_m2 = 0.0;                ///< wind from ahead or behind; 0: none
  std::optional<double> side_drag_area_m2;  ///< wind from the side; absent: drag_area_m2
  /// Height of the centre of pressure above level ground; absent: the centre of mass.
  std::optional<double> pressure_height_m;

  /// @throws ConfigError
  void validate(const std::string& name) const;
  double side_area_m2() const { return side_drag_area_m2.value_or(drag_area_m2); }
  bool none() const { return drag_area_m2 == 0.0 && side_area_m2() == 0.0; }
};

/// drag_area_m2, side_drag_area_m2, pressure_centre_height_m
const ParameterTable<AirDragParams>& air_drag_table();

/// @param air_B  velocity of the air relative to the vehicle, in B, m/s @returns force in B, N
Eigen::Vector3d calc_air_drag_B(const AirDragParams& params, double air_density_kgm3,
                                const Eigen::Vector3d& air_B);

}  // namespace vinerow::vehicles
