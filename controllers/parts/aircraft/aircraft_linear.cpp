#include "controllers/parts/aircraft/aircraft_linear.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "controllers/parts/aircraft/flight_equations.h"
#include "controllers/parts/aircraft/trim_solver.h"
#include "controllers/parts/solvers/discretise.h"
#include "engine/math/decomposition.h"

namespace vinerow::controllers {
namespace {

/// Steps of the central differences: third-order errors and rounding are both below 1e-9 of the
/// terms here, speeds of about 10 m/s and angles of about 0.1 rad.
constexpr double kVelocityStep_mps = 1e-4;
constexpr double kAngleStep_rad = 1e-5;

/// Rows and columns of `whole` by index.
template <std::size_t Rows, std::size_t Columns>
Eigen::MatrixXd block(const Eigen::MatrixXd& whole, const std::array<int, Rows>& rows,
                      const std::array<int, Columns>& columns) {
  Eigen::MatrixXd part(Rows, Columns);
  for (std::size_t i = 0; i < Rows; ++i) {
    for (std::size_t j = 0; j < Columns; ++j) {
      part(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = whole(rows[i], columns[j]);
    }
  }
  return part;
}

}  // namespace

AircraftLinear linearise(const Aircraft& aircraft, const Trim& trim) {
  FlightEquations equations(aircraft);
  const AirState x0 = air_state_of(trim);
  Eigen::MatrixXd A(10, 10), B(10, 3), E(10, 3);
  for (int i = 0; i < 10; ++i) {
    const double step = i <= kAirW ? kVelocityStep_mps : kAngleStep_rad;
    AirState more = x0, less = x0;
    more(i) += step;
    less(i) -= step;
    A.col(i) =
        (equations.derivative(more, trim.controls) - equations.derivative(less, trim.controls)) /
        (2.0 * step);
    if (i > kAirW) continue;
    const Eigen::Vector3d gust = step * Eigen::Vector3d::Unit(i);
    E.col(i) = (equations.derivative(x0, trim.controls, gust) -
                equations.derivative(x0, trim.controls, -gust)) /
               (2.0 * step);
  }
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = kAngleStep_rad * Eigen::Vector3d::Unit(i);
    const auto moved = [&](double sign) {
      return equations.derivative(x0, {trim.controls.throttle + sign * step.x(),
                                       trim.controls.elevator_rad + sign * step.y(),
                                       trim.controls.aileron_rad + sign * step.z()});
    };
    B.col(i) = (moved(1.0) - moved(-1.0)) / (2.0 * kAngleStep_rad);
  }
  constexpr std::array kLon{int{kAirU}, int{kAirW}, int{kAirQ}, int{kAirTheta}, int{kAirHeight}};
  constexpr std::array kLat{int{kAirV}, int{kAirP}, int{kAirR}, int{kAirPhi}, int{kAirPsi}};
  return {
      {block(A, kLon, kLon), block(B, kLon, std::array{0, 1}), block(E, kLon, std::array{0, 2})},
      {block(A, kLat, kLat), block(B, kLat, std::array{2}), block(E, kLat, std::array{1})}};
}

SampledAxis discretise(const LinearAxis& axis, double period_s) {
  Eigen::MatrixXd inputs(axis.A.rows(), axis.B.cols() + axis.E.cols());
  inputs << axis.B, axis.E;
  const SampledModel sampled = discretise(axis.A, inputs, period_s);
  return {sampled.A, sampled.B.leftCols(axis.B.cols()), sampled.B.rightCols(axis.E.cols())};
}

std::vector<FlightMode> calc_modes(const LinearAxis& axis) {
  const Eigen::VectorXcd roots = calc_eigenvalues(axis.A);
  std::vector<FlightMode> modes;
  for (const std::complex<double>& root : roots) {
    if (root.imag() < 0.0) continue;
    const double frequency = std::abs(root);
    modes.push_back({root, frequency, frequency > 0.0 ? -root.real() / frequency : 1.0});
  }
  std::stable_sort(modes.begin(), modes.end(), [](const FlightMode& a, const FlightMode& b) {
    return a.frequency_radps < b.frequency_radps;
  });
  return modes;
}

}  // namespace vinerow::controllers
