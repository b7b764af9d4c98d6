#include "vehicles/parts/wind_gusts.h"

#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::vehicles {

RandomGusts::RandomGusts(const Wind& wind)
    : statistics_(wind.random_gusts),
      random_(statistics_ ? statistics_->seed : 0, "", "world.wind.random_gusts") {
  if (none()) return;
  gust_.amplitude_mps = statistics_->amplitude_mps;
  gust_.duration_s = statistics_->duration_s;
  gust_.start_s = -gust_.duration_s;
  draw_next();
}

void RandomGusts::draw_next() {
  const double rest_s =
      -(statistics_->interval_s - gust_.duration_s) * std::log(1.0 - random_.uniform());
  gust_.start_s += gust_.duration_s + rest_s;
  gust_.from_azimuth_rad = random_.uniform(0.0, 2.0 * kPi);
}

const WindGust& RandomGusts::at(double time_s) {
  while (!none() && time_s >= gust_.start_s + gust_.duration_s) draw_next();
  return gust_;
}

}  // namespace vinerow::vehicles
