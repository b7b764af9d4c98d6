#include "engine/api/wind.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "engine/core/error.h"

namespace vinerow {
namespace {

void demand(bool good, const std::string& key, double value, const char* unit,
            const std::string& allowed) {
  if (good && std::isfinite(value)) return;
  throw ConfigError(fmt::format("wind.{} = {} {}, must be {}", key, value, unit, allowed));
}

void demand_not_negative(const char* key, double value, const char* unit) {
  demand(value >= 0.0, key, value, unit, fmt::format(">= 0 {}", unit));
}

}  // namespace

void validate(const Wind& w) {
  demand(w.air_density_kgm3 > 0.0, "air_density_kgm3", w.air_density_kgm3, "kg/m3", "> 0 kg/m3");
  demand_not_negative("mean_speed_mps", w.mean_speed_mps, "m/s");
  demand(w.reference_height_m > 0.0, "reference_height_m", w.reference_height_m, "m", "> 0 m");
  demand(w.roughness_length_m > 0.0, "roughness_length_m", w.roughness_length_m, "m", "> 0 m");
  if (w.height_law == WindHeightLaw::kLogarithmic) {
    demand(w.roughness_length_m < w.reference_height_m, "roughness_length_m", w.roughness_length_m,
           "m", fmt::format("< wind.reference_height_m = {} m", w.reference_height_m));
  }
  demand_not_negative("power_exponent", w.power_exponent, "");
  demand(true, "ground_speed_mps", w.ground_speed_mps, "m/s", "a finite number");
  demand_not_negative("turbulence", w.turbulence, "");
  demand_not_negative("turbulence_limit_mps", w.turbulence_limit_mps, "m/s");
  demand_not_negative("shelter", w.shelter_attenuation, "");
  for (std::size_t i = 0; i < w.gusts.size(); ++i) {
    const WindGust& gust = w.gusts[i];
    const std::string at = fmt::format("gusts[{}].", i);
    demand(gust.duration_s > 0.0, at + "duration_s", gust.duration_s, "s", "> 0 s");
    demand(gust.amplitude_mps >= 0.0, at + "amplitude_mps", gust.amplitude_mps, "m/s", ">= 0 m/s");
    demand(gust.front_speed_mps >= 0.0, at + "front_speed_mps", gust.front_speed_mps, "m/s",
           ">= 0 m/s");
    demand(true, at + "at_s", gust.start_s, "s", "a finite number");
    demand(true, at + "from_deg", gust.from_azimuth_rad, "rad", "a finite number");
    demand(true, at + "vertical_mps", gust.vertical_mps, "m/s", "a finite number");
  }
  if (w.random_gust_interval_s == 0.0) return;
  demand(w.random_gust_duration_s > 0.0, "random_gusts.duration_s", w.random_gust_duration_s, "s",
         "> 0 s");
  demand(w.random_gust_interval_s > w.random_gust_duration_s, "random_gusts.interval_s",
         w.random_gust_interval_s, "s",
         fmt::format("> wind.random_gusts.duration_s = {} s, for gusts by chance do not overlap",
                     w.random_gust_duration_s));
  demand_not_negative("random_gusts.amplitude_mps", w.random_gust_amplitude_mps, "m/s");
}

}  // namespace vinerow
