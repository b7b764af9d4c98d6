#include "engine/sensors/echo.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/parameter_table.h"

namespace vinerow::sensors {

const ParameterTable<EchoParams>& echo_table() {
  using P = EchoParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("echo_threshold", "", &P::threshold, between(0.0, 1e6),
                  "weakest echo that is detected, relative to a perfect reflector that fills the "
                  "cone at 1 m; 0: every return is detected")
          .number("echo_pulse_m", "m", &P::pulse_m, kPositive,
                  "returns closer together than this add up")
          .degrees("beam_half_power_deg", &P::beam_half_power_rad, kPositive,
                   "angle off the axis at which the echo, out and back, has half of its power")
          .number("absorption_db_per_m", "dB/m", &P::absorption_db_per_m, between(0.0, 100.0),
                  "absorption of sound in the air")
          .number("canopy_scatter", "", &P::canopy_scatter, between(0.0, 1.0),
                  "echo of leaves, relative to a perfect reflector")
          .number("ground_scatter", "", &P::ground_scatter, between(0.0, 1.0),
                  "echo of soil and grass seen from above")
          .number("stem_scatter", "", &P::stem_scatter, between(0.0, 1.0),
                  "echo of posts and trunks")
          .number("smooth_scatter", "", &P::smooth_scatter, between(0.0, 1.0),
                  "diffuse echo of hard smooth surfaces")
          .degrees("smooth_lobe_deg", &P::smooth_lobe_rad, kPositive,
                   "incidence at which a hard smooth surface reflects 1/e of the sound back");
  return table;
}

double beam_pattern(const EchoParams& params, double off_axis_rad) {
  const double ratio = off_axis_rad / params.beam_half_power_rad;
  return std::exp2(-ratio * ratio);
}

double surface_echo(const EchoParams& params, SurfaceClass surface, double cos_incidence) {
  const double c = std::clamp(cos_incidence, 0.0, 1.0);
  switch (surface) {
    case SurfaceClass::kCanopy:
      return params.canopy_scatter * (0.5 + 0.5 * c);
    case SurfaceClass::kTerrain:
      return params.ground_scatter * c;
    case SurfaceClass::kPost:
    case SurfaceClass::kTrunk:
    case SurfaceClass::kWire:
      return params.stem_scatter * c;
    case SurfaceClass::kObstacle:
    case SurfaceClass::kVehicle:
      break;
  }
  const double ratio = std::acos(c) / params.smooth_lobe_rad;
  return std::max(params.smooth_scatter * c, std::exp(-ratio * ratio));
}

double echo_spreading(const EchoParams& params, double distance_m) {
  return std::pow(10.0, -0.2 * params.absorption_db_per_m * (distance_m - 1.0)) /
         (distance_m * distance_m);
}

double first_echo_m(const EchoParams& params, std::span<EchoReturn> returns) {
  std::sort(returns.begin(), returns.end(),
            [](const EchoReturn& a, const EchoReturn& b) { return a.distance_m < b.distance_m; });
  double sum = 0.0;
  std::size_t end = 0;
  for (std::size_t first = 0; first < returns.size(); ++first) {
    const double until_m = returns[first].distance_m + params.pulse_m;
    for (; end < returns.size() && returns[end].distance_m <= until_m; ++end)
      sum += returns[end].strength;
    if (sum >= params.threshold) return returns[first].distance_m;
    sum -= returns[first].strength;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace vinerow::sensors
