#pragma once
/// A map projection from its series, to judge PROJ's by.

#include <Eigen/Core>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::io {

/// Transverse Mercator of UTM zone 32 on GRS80, as far as n^3 (below 1 mm in a zone).
/// Source: Krueger 1912, as given by Karney, "Transverse Mercator with an accuracy of a few
/// nanometers", J. Geodesy 85 (2011), eqs. 7 to 14 and 35.
inline Eigen::Vector2d utm32(double latitude_rad, double longitude_rad) {
  const double f = 1.0 / 298.257222101, n = f / (2.0 - f), e = std::sqrt(f * (2.0 - f));
  const double tau = std::tan(latitude_rad), lambda = longitude_rad - rad_from_deg(9.0);
  const double sigma = std::sinh(e * std::atanh(e * tau / std::hypot(1.0, tau)));
  const double tau1 = tau * std::hypot(1.0, sigma) - sigma * std::hypot(1.0, tau);
  const double xi1 = std::atan2(tau1, std::cos(lambda));
  const double eta1 = std::asinh(std::sin(lambda) / std::hypot(tau1, std::cos(lambda)));
  const double alpha[3] = {n / 2 - 2 * n * n / 3 + 5 * n * n * n / 16,
                           13 * n * n / 48 - 3 * n * n * n / 5, 61 * n * n * n / 240};
  double xi = xi1, eta = eta1;
  for (int j = 1; j <= 3; ++j) {
    xi += alpha[j - 1] * std::sin(2 * j * xi1) * std::cosh(2 * j * eta1);
    eta += alpha[j - 1] * std::cos(2 * j * xi1) * std::sinh(2 * j * eta1);
  }
  const double A = 6378137.0 / (1 + n) * (1 + n * n / 4 + n * n * n * n / 64);
  return {500000.0 + 0.9996 * A * eta, 0.9996 * A * xi};
}

}  // namespace vinerow::io
