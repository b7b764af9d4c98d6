#include "vehicles/parts/wind_gusts.h"

#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::vehicles {

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
