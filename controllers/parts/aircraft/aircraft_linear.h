#pragma once
/// Linear models of a fixed-wing vehicle about a trim: longitudinal x = [u w q theta h],
/// u = [d_t d_e], d = [u_g w_g]; lateral x = [v p r phi psi], u = d_a, d = v_g. All are deviations
/// from the trim in SI and rad, signs of aviation (aircraft.h), h positive up. Gusts are velocities
/// of the air against the vehicle's: 1 m/s of u_g changes the air velocity by -1 m/s in u.
/// The lags of motor and servos are ignored. Reference of paper A, section 1.

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "controllers/parts/aircraft/flight_trim.h"

namespace vinerow::controllers {

struct LinearAxis {
  Eigen::MatrixXd A;  ///< continuous, n x n
  Eigen::MatrixXd B;  ///< n x m
  Eigen::MatrixXd E;  ///< n x g, per 1 m/s of gust
};

struct AircraftLinear {
  LinearAxis longitudinal;  ///< 5 x 5, 5 x 2, 5 x 2
  LinearAxis lateral;       ///< 5 x 5, 5 x 1, 5 x 1
};

/// Central differences of the equations of six degrees of freedom, then the blocks of each axis.
AircraftLinear linearise(const Aircraft& aircraft, const Trim& trim);

/// x+ = A x + B u + E d, inputs and gusts held over `period_s`.
struct SampledAxis {
  Eigen::MatrixXd A, B, E;
};
SampledAxis discretise(const LinearAxis& axis, double period_s);

/// Eigenvalue s of A with its frequency |s| and damping -Re s / |s|.
struct FlightMode {
  std::complex<double> root;  ///< rad/s; of a pair, the one with positive imaginary part
  double frequency_radps = 0.0;
  double damping = 0.0;
};
/// Sorted by magnitude, one entry per pair; integrators (h, psi) are included.
std::vector<FlightMode> calc_modes(const LinearAxis& axis);

}  // namespace vinerow::controllers
