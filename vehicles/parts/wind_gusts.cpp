#include "vehicles/parts/wind_gusts.h"

#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::vehicles {

Eigen::Vector2d downwind_direction(double from_azimuth_rad) {
  return {-std::sin(from_azimuth_rad), -std::cos(from_azimuth_rad)};
}

double gust_pulse(const WindGust& gust, double time_s, const Eigen::Vector2d& p_W) {
  double t_s = time_s - gust.start_s;
  if (gust.front_speed_mps > 0.0) {
    t_s -= downwind_direction(gust.from_azimuth_rad).dot(p_W) / gust.front_speed_mps;
  }
  if (t_s <= 0.0 || t_s >= gust.duration_s) return 0.0;
  return 0.5 * (1.0 - std::cos(2.0 * kPi * t_s / gust.duration_s));
}

Eigen::Vector3d calc_gust_W(const WindGust& gust, double time_s, const Eigen::Vector2d& p_W) {
  const double pulse = gust_pulse(gust, time_s, p_W);
  if (pulse == 0.0) return Eigen::Vector3d::Zero();
  const Eigen::Vector2d to = downwind_direction(gust.from_azimuth_rad);
  return pulse * Eigen::Vector3d(gust.amplitude_mps * to.x(), gust.amplitude_mps * to.y(),
                                 gust.vertical_mps);
}

RandomGusts::RandomGusts(const Wind& wind)
    : interval_s_(wind.random_gust_interval_s),
      random_(wind.random_gust_seed, "", "world.wind.random_gusts") {
  gust_.amplitude_mps = wind.random_gust_amplitude_mps;
  gust_.duration_s = wind.random_gust_duration_s;
  gust_.start_s = -gust_.duration_s;
  if (!none()) draw_next();
}

void RandomGusts::draw_next() {
  const double rest_s = -(interval_s_ - gust_.duration_s) * std::log(1.0 - random_.uniform());
  gust_.start_s += gust_.duration_s + rest_s;
  gust_.from_azimuth_rad = random_.uniform(0.0, 2.0 * kPi);
}

const WindGust& RandomGusts::at(double time_s) {
  while (!none() && time_s >= gust_.start_s + gust_.duration_s) draw_next();
  return gust_;
}

}  // namespace vinerow::vehicles
