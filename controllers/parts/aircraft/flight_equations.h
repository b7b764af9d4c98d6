#pragma once
/// Equations of motion of a rigid aircraft over a flat earth in the signs of aviation (aircraft.h),
/// from its FlightModel. Trim and linearisation differentiate them.
///
/// Source: Beard, McLain, "Small unmanned aircraft", 2012, eq. 3.14-3.17, with any symmetric
/// inertia.

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "controllers/parts/aircraft/aircraft.h"

namespace vinerow::controllers {

/// Velocity over ground in body axes m/s, rates rad/s, angles rad, height m (up).
using AirState = Eigen::Matrix<double, 10, 1>;
enum AirStateIndex {
  kAirU = 0,
  kAirV,
  kAirW,
  kAirP,
  kAirQ,
  kAirR,
  kAirPhi,
  kAirTheta,
  kAirPsi,
  kAirHeight
};

class FlightEquations {
 public:
  explicit FlightEquations(const Aircraft& aircraft);

  /// Time derivative of the state. @param gust_mps  velocity of the air over ground in body axes
  AirState derivative(const AirState& x, const AircraftControls& controls,
                      const Eigen::Vector3d& gust_mps = Eigen::Vector3d::Zero());
  /// Force, N, and torque, N m, of air and propulsion in body axes.
  AirLoad load(const Eigen::Vector3d& air_velocity_mps, const Eigen::Vector3d& rates_radps,
               const AircraftControls& controls);

 private:
  Aircraft aircraft_;
  Eigen::Matrix3d inertia_, inertia_inverse_;
  std::vector<double> actuators_;
};

}  // namespace vinerow::controllers
