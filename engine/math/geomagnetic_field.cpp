#include "engine/math/geomagnetic_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace vinerow {
namespace {

constexpr int kDegree = 12;
constexpr double kReferenceRadius_m = 6'371'200.0;  // of the model's coefficients
constexpr double kSemiMajorAxis_m = 6'378'137.0;    // WGS84
constexpr double kFlattening = 1.0 / 298.257223563;

/// Gauss coefficients of one degree and order, nT and nT per year.
struct Coefficients {
  double g, h, g_rate, h_rate;
};
// WMM2025.COF, epoch 2025.0, released 2024-11-13: n = 1, m = 0; n = 1, m = 1; n = 2, m = 0; ...
// clang-format off
constexpr std::array<Coefficients, 90> kModel = {{
    {-29351.8, 0.0, 12.0, 0.0}, {-1410.8, 4545.4, 9.7, -21.5},
    {-2556.6, 0.0, -11.6, 0.0}, {2951.1, -3133.6, -5.2, -27.7}, {1649.3, -815.1, -8.0, -12.1},
    {1361.0, 0.0, -1.3, 0.0}, {-2404.1, -56.6, -4.2, 4.0}, {1243.8, 237.5, 0.4, -0.3},
    {453.6, -549.5, -15.6, -4.1},
    {895.0, 0.0, -1.6, 0.0}, {799.5, 278.6, -2.4, -1.1}, {55.7, -133.9, -6.0, 4.1},
    {-281.1, 212.0, 5.6, 1.6}, {12.1, -375.6, -7.0, -4.4},
    {-233.2, 0.0, 0.6, 0.0}, {368.9, 45.4, 1.4, -0.5}, {187.2, 220.2, 0.0, 2.2},
    {-138.7, -122.9, 0.6, 0.4}, {-142.0, 43.0, 2.2, 1.7}, {20.9, 106.1, 0.9, 1.9},
    {64.4, 0.0, -0.2, 0.0}, {63.8, -18.4, -0.4, 0.3}, {76.9, 16.8, 0.9, -1.6},
    {-115.7, 48.8, 1.2, -0.4}, {-40.9, -59.8, -0.9, 0.9}, {14.9, 10.9, 0.3, 0.7},
    {-60.7, 72.7, 0.9, 0.9},
    {79.5, 0.0, 0.0, 0.0}, {-77.0, -48.9, -0.1, 0.6}, {-8.8, -14.4, -0.1, 0.5},
    {59.3, -1.0, 0.5, -0.8}, {15.8, 23.4, -0.1, 0.0}, {2.5, -7.4, -0.8, -1.0},
    {-11.1, -25.1, -0.8, 0.6}, {14.2, -2.3, 0.8, -0.2},
    {23.2, 0.0, -0.1, 0.0}, {10.8, 7.1, 0.2, -0.2}, {-17.5, -12.6, 0.0, 0.5},
    {2.0, 11.4, 0.5, -0.4}, {-21.7, -9.7, -0.1, 0.4}, {16.9, 12.7, 0.3, -0.5},
    {15.0, 0.7, 0.2, -0.6}, {-16.8, -5.2, 0.0, 0.3}, {0.9, 3.9, 0.2, 0.2},
    {4.6, 0.0, 0.0, 0.0}, {7.8, -24.8, -0.1, -0.3}, {3.0, 12.2, 0.1, 0.3},
    {-0.2, 8.3, 0.3, -0.3}, {-2.5, -3.3, -0.3, 0.3}, {-13.1, -5.2, 0.0, 0.2},
    {2.4, 7.2, 0.3, -0.1}, {8.6, -0.6, -0.1, -0.2}, {-8.7, 0.8, 0.1, 0.4},
    {-12.9, 10.0, -0.1, 0.1},
    {-1.3, 0.0, 0.1, 0.0}, {-6.4, 3.3, 0.0, 0.0}, {0.2, 0.0, 0.1, 0.0},
    {2.0, 2.4, 0.1, -0.2}, {-1.0, 5.3, 0.0, 0.1}, {-0.6, -9.1, -0.3, -0.1},
    {-0.9, 0.4, 0.0, 0.1}, {1.5, -4.2, -0.1, 0.0}, {0.9, -3.8, -0.1, -0.1},
    {-2.7, 0.9, 0.0, 0.2}, {-3.9, -9.1, 0.0, 0.0},
    {2.9, 0.0, 0.0, 0.0}, {-1.5, 0.0, 0.0, 0.0}, {-2.5, 2.9, 0.0, 0.1},
    {2.4, -0.6, 0.0, 0.0}, {-0.6, 0.2, 0.0, 0.1}, {-0.1, 0.5, -0.1, 0.0},
    {-0.6, -0.3, 0.0, 0.0}, {-0.1, -1.2, 0.0, 0.1}, {1.1, -1.7, -0.1, 0.0},
    {-1.0, -2.9, -0.1, 0.0}, {-0.2, -1.8, -0.1, 0.0}, {2.6, -2.3, -0.1, 0.0},
    {-2.0, 0.0, 0.0, 0.0}, {-0.2, -1.3, 0.0, 0.0}, {0.3, 0.7, 0.0, 0.0},
    {1.2, 1.0, 0.0, -0.1}, {-1.3, -1.4, 0.0, 0.1}, {0.6, 0.0, 0.0, 0.0},
    {0.6, 0.6, 0.1, 0.0}, {0.5, -0.1, 0.0, 0.0}, {-0.1, 0.8, 0.0, 0.0},
    {-0.4, 0.1, 0.0, 0.0}, {-0.2, -1.0, -0.1, 0.0}, {-1.3, 0.1, 0.0, 0.0},
    {-0.7, 0.2, -0.1, -0.1},
}};
// clang-format on

/// Schmidt semi-normalised associated Legendre functions of cos(theta) and their derivatives by
/// theta. Recursion: WMM technical report, section 1.2, after Heiskanen and Moritz 1967.
struct Legendre {
  double p[kDegree + 1][kDegree + 1] = {};
  double dp[kDegree + 1][kDegree + 1] = {};

  Legendre(double cos_theta, double sin_theta) {
    p[0][0] = 1.0;
    for (int n = 1; n <= kDegree; ++n) {
      // From P(n-1, n-1), as in the report: the factor of n = 1 is 1.
      const double diagonal = n == 1 ? 1.0 : std::sqrt((2.0 * n - 1.0) / (2.0 * n));
      p[n][n] = diagonal * sin_theta * p[n - 1][n - 1];
      dp[n][n] = diagonal * (sin_theta * dp[n - 1][n - 1] + cos_theta * p[n - 1][n - 1]);
      for (int m = 0; m < n; ++m) {
        const double root = std::sqrt(static_cast<double>(n * n - m * m));
        const double last =
            n - 2 >= m ? std::sqrt(static_cast<double>((n - 1) * (n - 1) - m * m)) : 0.0;
        const double p_last = n >= 2 ? p[n - 2][m] : 0.0;
        const double dp_last = n >= 2 ? dp[n - 2][m] : 0.0;
        const double a = 2.0 * n - 1.0;
        p[n][m] = (a * cos_theta * p[n - 1][m] - last * p_last) / root;
        dp[n][m] =
            (a * (cos_theta * dp[n - 1][m] - sin_theta * p[n - 1][m]) - last * dp_last) / root;
      }
    }
  }
};

}  // namespace

Eigen::Vector3d calc_geomagnetic_field_T(double latitude_rad, double longitude_rad,
                                         double altitude_m, double year) {
  // Geocentric radius and latitude.
  constexpr double kEccentricity2 = kFlattening * (2.0 - kFlattening);
  const double limit = 0.5 * std::numbers::pi - 1e-7;
  const double latitude = std::clamp(latitude_rad, -limit, limit);
  const double sine = std::sin(latitude), cosine = std::cos(latitude);
  const double curvature_m = kSemiMajorAxis_m / std::sqrt(1.0 - kEccentricity2 * sine * sine);
  const double axis_m = (curvature_m + altitude_m) * cosine;
  const double height_m = (curvature_m * (1.0 - kEccentricity2) + altitude_m) * sine;
  const double radius_m = std::hypot(axis_m, height_m);
  const double cos_theta = height_m / radius_m, sin_theta = axis_m / radius_m;

  // Minus the gradient of the potential: south, east and up in geocentric axes, nT.
  const Legendre legendre(cos_theta, sin_theta);
  const double ratio = kReferenceRadius_m / radius_m;
  const double years = year - kFirstGeomagneticYear;
  double south = 0.0, east = 0.0, up = 0.0;
  double scale = ratio * ratio;
  std::size_t k = 0;
  for (int n = 1; n <= kDegree; ++n) {
    scale *= ratio;
    for (int m = 0; m <= n; ++m, ++k) {
      const Coefficients& c = kModel[k];
      const double g = c.g + years * c.g_rate, h = c.h + years * c.h_rate;
      const double cos_m = std::cos(m * longitude_rad), sin_m = std::sin(m * longitude_rad);
      const double along = g * cos_m + h * sin_m;
      up += scale * (n + 1) * along * legendre.p[n][m];
      south -= scale * along * legendre.dp[n][m];
      east += scale * m * (g * sin_m - h * cos_m) * legendre.p[n][m] / sin_theta;
    }
  }
  // From the geocentric vertical to the ellipsoid's normal.
  const double tilt = latitude - std::atan2(height_m, axis_m);
  const double north = -south;
  return Eigen::Vector3d(east, north * std::cos(tilt) - up * std::sin(tilt),
                         north * std::sin(tilt) + up * std::cos(tilt)) *
         1e-9;
}

}  // namespace vinerow
