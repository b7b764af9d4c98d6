#pragma once
/// One number for each deviation and control of a fixed-wing vehicle, used for limits and weights.

#include <Eigen/Core>

#include "engine/api/parameter_table_fwd.h"

namespace vinerow::controllers {

struct AircraftRanges {
  /// u m/s, w m/s, q rad/s, theta rad, h m
  Eigen::Matrix<double, 5, 1> lon = Eigen::Matrix<double, 5, 1>::Zero();
  /// v m/s, p rad/s, r rad/s, phi rad, psi rad
  Eigen::Matrix<double, 5, 1> lat = Eigen::Matrix<double, 5, 1>::Zero();
  double throttle = 0.0;
  double elevator_rad = 0.0;
  double aileron_rad = 0.0;
};

/// The same as in files: angles in deg, rates in deg/s.
struct AircraftRangesInDeg {
  double u_mps, w_mps, q_degps, theta_deg, h_m;
  double throttle, elevator_deg;
  double v_mps, p_degps, r_degps, phi_deg, psi_deg;
  double aileron_deg;

  AircraftRanges to_si() const;
};

/// Parameter table with the names of AircraftRangesInDeg, each > 0: fields of a group.
const ParameterTable<AircraftRanges>& aircraft_range_table();

}  // namespace vinerow::controllers
