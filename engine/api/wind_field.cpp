#include "engine/api/wind_field.h"

#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow {

double mean_wind_mps(const Wind& wind, double height_m) {
  switch (wind.height_law) {
    case WindHeightLaw::kUniform:
      break;
    case WindHeightLaw::kLogarithmic:
      if (height_m <= wind.roughness_length_m) return 0.0;
      return wind.mean_speed_mps * std::log(height_m / wind.roughness_length_m) /
             std::log(wind.reference_height_m / wind.roughness_length_m);
    case WindHeightLaw::kPower:
      if (height_m <= 0.0) return 0.0;
      return wind.mean_speed_mps *
             std::pow(height_m / wind.reference_height_m, wind.power_exponent);
    case WindHeightLaw::kLinear:
      return wind.ground_speed_mps + (wind.mean_speed_mps - wind.ground_speed_mps) *
                                         std::max(0.0, height_m) / wind.reference_height_m;
  }
  return wind.mean_speed_mps;
}

Eigen::Vector2d downwind_direction(double from_azimuth_rad) {
  return {-std::sin(from_azimuth_rad), -std::cos(from_azimuth_rad)};
}

namespace {

Eigen::Vector2d gust_direction(const Wind& wind, const WindGust& gust) {
  return downwind_direction(gust.from_azimuth_rad.value_or(wind.from_azimuth_rad));
}

}  // namespace

double gust_pulse(const Wind& wind, const WindGust& gust, double time_s,
                  const Eigen::Vector2d& p_W) {
  double t_s = time_s - gust.start_s;
  if (gust.front_speed_mps > 0.0) {
    t_s -= gust_direction(wind, gust).dot(p_W) / gust.front_speed_mps;
  }
  if (t_s <= 0.0 || t_s >= gust.duration_s) return 0.0;
  return 0.5 * (1.0 - std::cos(2.0 * kPi * t_s / gust.duration_s));
}

Eigen::Vector3d calc_gust_W(const Wind& wind, const WindGust& gust, double time_s,
                            const Eigen::Vector2d& p_W) {
  const double pulse = gust_pulse(wind, gust, time_s, p_W);
  if (pulse == 0.0) return Eigen::Vector3d::Zero();
  const Eigen::Vector2d to = gust_direction(wind, gust);
  return pulse * Eigen::Vector3d(gust.amplitude_mps * to.x(), gust.amplitude_mps * to.y(),
                                 gust.vertical_mps);
}

}  // namespace vinerow
