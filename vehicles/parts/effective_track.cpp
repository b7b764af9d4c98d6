#include "vehicles/parts/effective_track.h"

namespace vinerow::vehicles {

double calc_effective_track_m(double track_m, double wheel_base_m) {
  return track_m + wheel_base_m * wheel_base_m / track_m;
}

}  // namespace vinerow::vehicles
