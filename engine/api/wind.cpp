#include "engine/api/wind.h"

#include <fmt/format.h>

#include <string>

#include "engine/api/parameter_table.h"

namespace vinerow {
namespace {

constexpr double kStorm_mps = 100.0;  // above any recorded wind at 10 m, except in tornadoes

const ParameterTable<WindGust>& gust_table() {
  using P = WindGust;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("at_s", "s", &P::start_s, between(0.0, 1e7), "start of the pulse")
          .required()
          .number("duration_s", "s", &P::duration_s, kPositive,
                  "duration of a gust, from calm to calm")
          .number("amplitude_mps", "m/s", &P::amplitude_mps, between(0.0, kStorm_mps),
                  "horizontal, in the middle of the pulse")
          .required()
          .degrees("from_deg", &P::from_azimuth_rad, between(-360.0, 360.0),
                   "direction it comes from, clockwise from north; default: that of the wind")
          .number("vertical_mps", "m/s", &P::vertical_mps, between(-kStorm_mps, kStorm_mps),
                  "upward component, in the middle of the pulse")
          .number("front_speed_mps", "m/s", &P::front_speed_mps, between(0.0, kStorm_mps),
                  "speed of a front that is at the world's origin at at_s; 0: everywhere at "
                  "once");
  return table;
}

std::string judge_gusts(const GustStatistics& gusts) {
  if (gusts.interval_s > gusts.duration_s) return "";
  return fmt::format(
      "interval_s = {} s, must be > duration_s = {} s, because random gusts do not overlap",
      gusts.interval_s, gusts.duration_s);
}

const ParameterTable<GustStatistics>& random_gust_table() {
  using P = GustStatistics;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("interval_s", "s", &P::interval_s, kPositive,
                  "mean time between starts of gusts, more than duration_s")
          .required()
          .number("amplitude_mps", "m/s", &P::amplitude_mps, between(0.0, kStorm_mps),
                  "horizontal, in the middle of the pulse; from a random direction")
          .number("duration_s", "s", &P::duration_s, kPositive,
                  "duration of a gust, from calm to calm")
          .rule(judge_gusts);
  return table;
}

std::string judge_roughness(const Wind& wind) {
  if (wind.height_law != WindHeightLaw::kLogarithmic) return "";
  if (wind.roughness_length_m < wind.reference_height_m) return "";
  return fmt::format("roughness_length_m = {} m, must be < reference_height_m = {} m",
                     wind.roughness_length_m, wind.reference_height_m);
}

}  // namespace

const ParameterTable<Wind>& wind_table() {
  using P = Wind;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("mean_speed_mps", "m/s", &P::mean_speed_mps, between(0.0, kStorm_mps),
                  "mean wind at reference_height_m above the ground")
          .degrees("from_deg", &P::from_azimuth_rad, between(-360.0, 360.0),
                   "direction the wind comes from, clockwise from north")
          .number("reference_height_m", "m", &P::reference_height_m, kPositive,
                  "height above the ground of mean_speed_mps")
          .choice("height_law", &P::height_law,
                  {{"uniform", WindHeightLaw::kUniform},
                   {"logarithmic", WindHeightLaw::kLogarithmic},
                   {"power", WindHeightLaw::kPower},
                   {"linear", WindHeightLaw::kLinear}},
                  "height law of the mean wind")
          .number("roughness_length_m", "m", &P::roughness_length_m, kPositive,
                  "logarithmic law, less than reference_height_m: 0.03 grass, 0.1 low "
                  "crops, 0.25 high crops (Wieringa 1992)")
          .number("power_exponent", "", &P::power_exponent, between(0.0, 1.0),
                  "exponent of the power law")
          .number("ground_speed_mps", "m/s", &P::ground_speed_mps, between(-kStorm_mps, kStorm_mps),
                  "linear law: wind at the ground; < 0: opposite direction")
          .number("turbulence", "", &P::turbulence, between(0.0, 10.0),
                  "factor on the Dryden turbulence of MIL-F-8785C, low altitude; 0: none")
          .number("turbulence_wind_mps", "m/s", &P::turbulence_wind_mps, between(0.0, kStorm_mps),
                  "wind at 20 ft that scales the turbulence; default: the mean wind at that height")
          .number("turbulence_limit_mps", "m/s", &P::turbulence_limit_mps, between(0.0, kStorm_mps),
                  "maximum length of the turbulence vector; 0: no limit")
          .groups("gusts", &P::gusts, gust_table(), "1-cosine pulses at given times")
          .group("random_gusts", &P::random_gusts, random_gust_table(),
                 "1-cosine pulses at random times, the same for all vehicles")
          .number("shelter", "", &P::shelter_attenuation, between(0.0, 5.0),
                  "attenuation a of exp(-a (1 - z/top)) across the rows of a block; 0: "
                  "none, 1.2: vines of leaf area index 2 (Goudriaan 1977)")
          .boolean("shelter_by_leaves", &P::shelter_by_leaves,
                   "true: shelter follows from the leaf area of the world's plants")
          .choice("atmosphere", &P::atmosphere,
                  {{"constant", Atmosphere::kConstant}, {"us76", Atmosphere::kStandard76}},
                  "uniform density, or US Standard Atmosphere 1976")
          .number("air_density_kgm3", "kg/m3", &P::air_density_kgm3, above(0.0, 100.0),
                  "density of a constant atmosphere; default: that of the standard at the altitude "
                  "of the world's origin, 1.225 at sea level")
          .rule(judge_roughness)
          .rule([](const P& wind) -> std::string {
            if (!wind.shelter_by_leaves || wind.shelter_attenuation == 0.0) return "";
            return "shelter and shelter_by_leaves exclude each other: give one of them";
          });
  return table;
}

void validate(const Wind& wind) {
  wind_table().validate(wind, "wind");
}

}  // namespace vinerow
