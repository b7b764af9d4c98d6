#include "vehicles/parts/effective_track.h"

namespace vinerow::vehicles {

double calc_effective_track_m(double track_m, double wheel_base_m) {
  return track_m + wheel_base_m * wheel_base_m / track_m;
}

double calc_small_slip_track_m(double track_m, double wheel_base_m, const Soil& soil) {
  const double ratio = wheel_base_m / track_m;
  return track_m * (1.0 + soil.cornering_stiffness_per_rad / soil.slip_stiffness * ratio * ratio);
}

}  // namespace vinerow::vehicles
