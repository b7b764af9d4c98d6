#include "engine/sensors/echo.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/angles.h"

namespace vinerow {

std::vector<ParameterSpec> echo_parameters() {
  const auto share = [](const char* name, double value, const char* text) {
    return number_parameter(name, "", value, 0.0, 1.0, text);
  };
  return {
      number_parameter("echo_threshold", "", 0.0, 0.0, 1e6,
                       "weakest echo that is heard, of a perfect reflector that fills the cone at "
                       "1 m; 0: every return is heard"),
      positive_parameter("echo_pulse_m", "m", 0.034, "returns nearer to each other add up"),
      positive_parameter("beam_half_power_deg", "deg", 15.0,
                         "off the axis the echo, out and back, has half of its power"),
      number_parameter("absorption_db_per_m", "dB/m", 1.3, 0.0, 100.0, "of sound in the air"),
      share("canopy_scatter", 0.2, "echo of leaves, of a perfect reflector's"),
      share("ground_scatter", 0.05, "echo of soil and grass seen from above"),
      share("stem_scatter", 0.2, "echo of posts and trunks"),
      share("smooth_scatter", 0.01, "echo of hard smooth surfaces aside of the mirrored one"),
      positive_parameter("smooth_lobe_deg", "deg", 7.0,
                         "incidence at which a hard smooth surface mirrors 1/e of the sound back"),
  };
}

EchoParams read_echo(const ParameterSet& parameters) {
  EchoParams params;
  params.threshold = parameters.number("echo_threshold");
  params.pulse_m = parameters.number("echo_pulse_m");
  params.beam_half_power_rad = rad_from_deg(parameters.number("beam_half_power_deg"));
  params.absorption_db_per_m = parameters.number("absorption_db_per_m");
  params.canopy_scatter = parameters.number("canopy_scatter");
  params.ground_scatter = parameters.number("ground_scatter");
  params.stem_scatter = parameters.number("stem_scatter");
  params.smooth_scatter = parameters.number("smooth_scatter");
  params.smooth_lobe_rad = rad_from_deg(parameters.number("smooth_lobe_deg"));
  return params;
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

double first_heard_m(const EchoParams& params, std::span<EchoReturn> returns) {
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

}  // namespace vinerow
