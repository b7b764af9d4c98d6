#include "engine/imaging/atmosphere.h"

#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::imaging {

namespace {

constexpr double kGroundRadius = 6.360e6;  // m
constexpr double kTopRadius = 6.420e6;     // m
constexpr double kAirScale = 8000.0;       // m
constexpr double kHazeScale = 1200.0;      // m
// Scattering at sea level for 680, 550 and 440 nm, 1/m.
const Eigen::Array3d kAir(5.8e-6, 13.5e-6, 33.1e-6);
constexpr double kHaze = 12e-6;
constexpr double kHazeForward = 0.76;  // Henyey-Greenstein's g

/// Length of a ray from inside to the top of the atmosphere.
double length_to_top(const Eigen::Vector3d& p, const Eigen::Vector3d& direction) {
  const double b = p.dot(direction);
  return -b + std::sqrt(b * b - p.squaredNorm() + kTopRadius * kTopRadius);
}

/// Optical depths of air and haze along a ray to the top.
Eigen::Array2d depth_to_top(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  constexpr int kSteps = 8;
  const double step = length_to_top(from, direction) / kSteps;
  Eigen::Array2d depth(0.0, 0.0);
  for (int i = 0; i < kSteps; ++i) {
    const double h = (from + direction * (step * (i + 0.5))).norm() - kGroundRadius;
    if (h < -2000.0) return {1e30, 1e30};
    depth += step * Eigen::Array2d(std::exp(-h / kAirScale), std::exp(-h / kHazeScale));
  }
  return depth;
}

Eigen::Array3d transmittance(const Eigen::Array2d& depth) {
  return (-(kAir * depth[0] + kHaze * 1.1 * depth[1])).exp();
}

/// Radiance from a direction, for a viewer near the ground.
Eigen::Array3d calc_radiance(const Eigen::Vector3d& direction, const Eigen::Vector3d& sun) {
  constexpr int kSteps = 24;
  const Eigen::Vector3d eye(0, 0, kGroundRadius + 200.0);
  const double length = length_to_top(eye, direction);
  const double mu = direction.dot(sun);
  const double g = kHazeForward;
  const double phase_air = 3.0 / (16.0 * kPi) * (1.0 + mu * mu);
  const double phase_haze = (1.0 - g * g) / (4.0 * kPi * std::pow(1.0 + g * g - 2.0 * g * mu, 1.5));
  // Higher scattering orders: isotropic light, as a share of the first order.
  constexpr double kHigherOrders = 0.9;
  const double isotropic = 1.0 / (4.0 * kPi);

  Eigen::Array2d depth(0.0, 0.0);
  Eigen::Array3d radiance = Eigen::Array3d::Zero();
  double from = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    // Steps grow with distance, because air is densest near the viewer.
    const double share = (i + 1.0) / kSteps;
    const double to = length * share * share;
    const double step = to - from;
    const Eigen::Vector3d p = eye + direction * (0.5 * (from + to));
    from = to;
    const double h = p.norm() - kGroundRadius;
    const Eigen::Array2d density(std::exp(-h / kAirScale), std::exp(-h / kHazeScale));
    depth += 0.5 * step * density;
    const Eigen::Array3d light = transmittance(depth + depth_to_top(p, sun));
    depth += 0.5 * step * density;
    const Eigen::Array3d once = kAir * (density[0] * phase_air) + kHaze * density[1] * phase_haze;
    const Eigen::Array3d again = (kAir * density[0] + kHaze * density[1]) * isotropic;
    radiance += step * (light * once +
                        kHigherOrders * again * transmittance(depth) * std::max(0.15, sun.z()));
  }
  return radiance;
}

}  // namespace

Atmosphere calc_atmosphere(double sun_elevation_rad) {
  const double elevation = std::clamp(sun_elevation_rad, rad_from_deg(2.0), 0.5 * kPi);
  const Eigen::Vector3d sun(std::cos(elevation), 0.0, std::sin(elevation));
  Atmosphere result;
  result.sky.resize(Atmosphere::kAzimuths * Atmosphere::kElevations);
  Eigen::Array3d level = Eigen::Array3d::Zero();
  Eigen::Array3d near_sun = Eigen::Array3d::Zero();
  Eigen::Array3d far_sun = Eigen::Array3d::Zero();
  const auto elevation_of = [](double i) {
    const double share = std::clamp(i / (Atmosphere::kElevations - 1), 0.0, 1.0);
    return 0.5 * kPi * share * share;
  };
  for (int i = 0; i < Atmosphere::kElevations; ++i) {
    const double e = elevation_of(i);
    for (int k = 0; k < Atmosphere::kAzimuths; ++k) {
      const double a = kPi * k / (Atmosphere::kAzimuths - 1);
      const Eigen::Vector3d direction(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a),
                                      std::sin(e));
      const Eigen::Array3d radiance = calc_radiance(direction, sun);
      result.sky[i * Atmosphere::kAzimuths + k] = radiance.matrix().cast<float>();
      const double band = std::sin(elevation_of(i + 0.5)) - std::sin(elevation_of(i - 0.5));
      const bool edge = k == 0 || k == Atmosphere::kAzimuths - 1;
      const double width = (edge ? 1.0 : 2.0) * kPi / (Atmosphere::kAzimuths - 1);
      level += radiance * (band * width * std::sin(e));
    }
  }
  // Haze in front of hills has the mean colour of the first degrees above the horizon.
  for (int i = 2; i < 12; ++i) {
    near_sun += result.sky[i * Atmosphere::kAzimuths + 8].cast<double>().array() / 10.0;
    far_sun += result.sky[i * Atmosphere::kAzimuths + 38].cast<double>().array() / 10.0;
  }
  const Eigen::Vector3d ground(0, 0, kGroundRadius + 200.0);
  result.sun_irradiance = transmittance(depth_to_top(ground, sun)).matrix().cast<float>();
  result.sky_irradiance = level.matrix().cast<float>();
  result.horizon_to_sun = near_sun.matrix().cast<float>();
  result.horizon_from_sun = far_sun.matrix().cast<float>();
  return result;
}

}  // namespace vinerow::imaging
