#include "worlds/parts/wind.h"

#include "engine/api/parameter_table.h"

namespace vinerow::worlds {
namespace {

constexpr double kStorm_mps = 100.0;  // beyond any wind on record at 10 m but a tornado's

const ParameterTable<WindParams::Gust>& gust_table() {
  using P = WindParams::Gust;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("at_s", "s", inside(&P::gust, &WindGust::start_s), between(0.0, 1e7),
                  "start of the pulse")
          .required()
          .number("duration_s", "s", inside(&P::gust, &WindGust::duration_s), kPositive,
                  "from calm to calm")
          .number("amplitude_mps", "m/s", inside(&P::gust, &WindGust::amplitude_mps),
                  between(0.0, kStorm_mps), "horizontal, in the middle of the pulse")
          .required()
          .degrees("from_deg", &P::from_azimuth_rad, between(-360.0, 360.0),
                   "where it comes from, clockwise from north; default: as the wind")
          .number("vertical_mps", "m/s", inside(&P::gust, &WindGust::vertical_mps),
                  between(-kStorm_mps, kStorm_mps), "upward part, in the middle of the pulse")
          .number("front_speed_mps", "m/s", inside(&P::gust, &WindGust::front_speed_mps),
                  between(0.0, kStorm_mps),
                  "of a front that is at the world's origin at at_s; 0: everywhere at once");
  return table;
}

const ParameterTable<WindParams::RandomGusts>& random_gust_table() {
  using P = WindParams::RandomGusts;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("interval_s", "s", &P::interval_s, kPositive,
                  "mean time from gust to gust, more than duration_s")
          .required()
          .number("amplitude_mps", "m/s", &P::amplitude_mps, between(0.0, kStorm_mps),
                  "horizontal, in the middle of the pulse; from any side")
          .number("duration_s", "s", &P::duration_s, kPositive, "from calm to calm");
  return table;
}

}  // namespace

const ParameterTable<WindParams>& wind_table() {
  using P = WindParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("mean_speed_mps", "m/s", inside(&P::wind, &Wind::mean_speed_mps),
                  between(0.0, kStorm_mps), "mean wind at reference_height_m above the ground")
          .degrees("from_deg", inside(&P::wind, &Wind::from_azimuth_rad), between(-360.0, 360.0),
                   "where the wind comes from, clockwise from north")
          .number("reference_height_m", "m", inside(&P::wind, &Wind::reference_height_m), kPositive,
                  "above the ground, of mean_speed_mps")
          .choice("height_law", inside(&P::wind, &Wind::height_law),
                  {{"uniform", WindHeightLaw::kUniform},
                   {"logarithmic", WindHeightLaw::kLogarithmic},
                   {"power", WindHeightLaw::kPower},
                   {"linear", WindHeightLaw::kLinear}},
                  "how the mean wind grows with height")
          .number("roughness_length_m", "m", inside(&P::wind, &Wind::roughness_length_m), kPositive,
                  "of the logarithmic law, below reference_height_m: 0.03 grass, 0.1 low "
                  "crops, 0.25 high crops (Wieringa 1992)")
          .number("power_exponent", "", inside(&P::wind, &Wind::power_exponent), between(0.0, 1.0),
                  "of the power law")
          .number("ground_speed_mps", "m/s", inside(&P::wind, &Wind::ground_speed_mps),
                  between(-kStorm_mps, kStorm_mps),
                  "of the linear law: wind at the ground; < 0 blows the other way")
          .number("turbulence", "", inside(&P::wind, &Wind::turbulence), between(0.0, 10.0),
                  "factor on the Dryden turbulence of MIL-F-8785C, low altitude; 0: none")
          .number("turbulence_wind_mps", "m/s", &P::turbulence_wind_mps, between(0.0, kStorm_mps),
                  "wind at 20 ft that sets the turbulence; default: the mean wind there")
          .number("turbulence_limit_mps", "m/s", inside(&P::wind, &Wind::turbulence_limit_mps),
                  between(0.0, kStorm_mps),
                  "largest length of the turbulence's vector; 0: no limit")
          .groups("gusts", &P::gusts, gust_table(), "1-cosine pulses at given times")
          .group("random_gusts", &P::random_gusts, random_gust_table(),
                 "1-cosine pulses at random times, the same for all vehicles")
          .number("shelter", "", inside(&P::wind, &Wind::shelter_attenuation), between(0.0, 5.0),
                  "attenuation a of exp(-a (1 - z/top)) across the rows of a block; 0: "
                  "none, 1.2: vines of leaf area index 2 (Goudriaan 1977)")
          .choice("atmosphere", inside(&P::wind, &Wind::atmosphere),
                  {{"constant", Atmosphere::kConstant}, {"us76", Atmosphere::kStandard76}},
                  "density everywhere alike, or US Standard Atmosphere 1976")
          .number("air_density_kgm3", "kg/m3", inside(&P::wind, &Wind::air_density_kgm3), kPositive,
                  "of a constant atmosphere");
  return table;
}

Wind make_wind(const WindParams& params, std::uint64_t seed) {
  Wind wind = params.wind;
  wind.turbulence_wind_mps = params.turbulence_wind_mps.value_or(wind.turbulence_wind_mps);
  for (const WindParams::Gust& pulse : params.gusts) {
    WindGust gust = pulse.gust;
    gust.from_azimuth_rad = pulse.from_azimuth_rad.value_or(wind.from_azimuth_rad);
    wind.gusts.push_back(gust);
  }
  if (params.random_gusts) {
    wind.random_gust_interval_s = params.random_gusts->interval_s;
    wind.random_gust_amplitude_mps = params.random_gusts->amplitude_mps;
    wind.random_gust_duration_s = params.random_gusts->duration_s;
    wind.random_gust_seed = seed;
  }
  validate(wind);
  return wind;
}

}  // namespace vinerow::worlds
