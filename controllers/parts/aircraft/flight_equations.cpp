#include "controllers/parts/aircraft/flight_equations.h"

#include <Eigen/Geometry>
#include <cmath>

namespace vinerow::controllers {
namespace {

/// From body axes x forward, y left, z up to x forward, y right, z down, and back.
Eigen::Vector3d turn_over(const Eigen::Vector3d& vector) {
  return {vector.x(), -vector.y(), -vector.z()};
}

}  // namespace

FlightEquations::FlightEquations(const Aircraft& aircraft)
    : aircraft_(aircraft), actuators_(aircraft.actuators.size(), 0.0) {
  const Eigen::DiagonalMatrix<double, 3> turn(1.0, -1.0, -1.0);
  inertia_ = turn * aircraft.flight_model->inertia_B() * turn;
  inertia_inverse_ = inertia_.inverse();
}

AirLoad FlightEquations::load(const Eigen::Vector3d& air_velocity_mps,
                              const Eigen::Vector3d& rates_radps,
                              const AircraftControls& controls) {
  aircraft_.mix(controls, actuators_);
  AirLoad load = aircraft_.flight_model->load(
      {turn_over(air_velocity_mps), turn_over(rates_radps), aircraft_.air_density_kgm3},
      actuators_);
  load.force_B = turn_over(load.force_B);
  load.torque_B = turn_over(load.torque_B);
  return load;
}

AirState FlightEquations::derivative(const AirState& x, const AircraftControls& controls,
                                     const Eigen::Vector3d& gust_mps) {
  const Eigen::Vector3d velocity = x.segment<3>(kAirU), rates = x.segment<3>(kAirP);
  const AirLoad air = load(velocity - gust_mps, rates, controls);
  const double sin_phi = std::sin(x(kAirPhi)), cos_phi = std::cos(x(kAirPhi));
  const double sin_theta = std::sin(x(kAirTheta)), cos_theta = std::cos(x(kAirTheta));
  // The vertical, downwards, in body axes.
  const Eigen::Vector3d down(-sin_theta, sin_phi * cos_theta, cos_phi * cos_theta);
  AirState rate;
  rate.segment<3>(kAirU) = air.force_B / aircraft_.flight_model->mass_kg() +
                           aircraft_.gravity_mps2 * down - rates.cross(velocity);
  rate.segment<3>(kAirP) = inertia_inverse_ * (air.torque_B - rates.cross(inertia_ * rates));
  const double turning = sin_phi * rates.y() + cos_phi * rates.z();
  rate(kAirPhi) = rates.x() + turning * sin_theta / cos_theta;
  rate(kAirTheta) = cos_phi * rates.y() - sin_phi * rates.z();
  rate(kAirPsi) = turning / cos_theta;
  rate(kAirHeight) = -down.dot(velocity);
  return rate;
}

}  // namespace vinerow::controllers
