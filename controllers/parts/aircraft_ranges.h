#pragma once
/// One number for each deviation and control of a vehicle on wings: limits are such, and weights.

#include <Eigen/Core>
#include <string>

#include "engine/api/parameters.h"

namespace vinerow {

struct AircraftRanges {
  /// u m/s, w m/s, q rad/s, theta rad, h m
  Eigen::Matrix<double, 5, 1> lon;
  /// v m/s, p rad/s, r rad/s, phi rad, psi rad
  Eigen::Matrix<double, 5, 1> lat;
  double throttle = 0.0;
  double elevator_rad = 0.0;
  double aileron_rad = 0.0;
};

/// As files have them: angles in deg, rates in deg/s.
struct AircraftRangesInDeg {
  double u_mps, w_mps, q_degps, theta_deg, h_m;
  double throttle, elevator_deg;
  double v_mps, p_degps, r_degps, phi_deg, psi_deg;
  double aileron_deg;

  AircraftRanges to_si() const;
};

/// Group of these names, each > 0.
ParameterSpec aircraft_range_parameter(std::string name, const AircraftRangesInDeg& defaults,
                                       std::string description);
/// @param name  of the group; the defaults where it is not given
AircraftRanges read_aircraft_ranges(const ParameterSet& parameters, const std::string& name,
                                    const AircraftRangesInDeg& defaults);

}  // namespace vinerow
