#include "worlds/parts/wind.h"

#include "engine/math/angles.h"

namespace vinerow::worlds {
namespace {

constexpr double kStorm_mps = 100.0;  // beyond any wind on record at 10 m but a tornado's

std::vector<ParameterSpec> gust_fields() {
  const WindGust d;
  return {
      required(number_parameter("at_s", "s", 0, 0, 1e7, "start of the pulse")),
      positive_parameter("duration_s", "s", d.duration_s, "from calm to calm"),
      required(number_parameter("amplitude_mps", "m/s", 0, 0, kStorm_mps,
                                "horizontal, in the middle of the pulse")),
      optional(number_parameter("from_deg", "deg", 0, -360, 360,
                                "where it comes from, clockwise from north; default: as the wind")),
      number_parameter("vertical_mps", "m/s", d.vertical_mps, -kStorm_mps, kStorm_mps,
                       "upward part, in the middle of the pulse"),
      number_parameter("front_speed_mps", "m/s", d.front_speed_mps, 0, kStorm_mps,
                       "of a front that is at the world's origin at at_s; 0: everywhere at once")};
}

std::vector<ParameterSpec> random_gust_fields() {
  const Wind d;
  return {required(positive_parameter("interval_s", "s", 60,
                                      "mean time from gust to gust, more than duration_s")),
          number_parameter("amplitude_mps", "m/s", d.random_gust_amplitude_mps, 0, kStorm_mps,
                           "horizontal, in the middle of the pulse; from any side"),
          positive_parameter("duration_s", "s", d.random_gust_duration_s, "from calm to calm")};
}

WindHeightLaw height_law_of(const std::string& name) {
  if (name == "uniform") return WindHeightLaw::kUniform;
  if (name == "linear") return WindHeightLaw::kLinear;
  return name == "power" ? WindHeightLaw::kPower : WindHeightLaw::kLogarithmic;
}

}  // namespace

ParameterSpec wind_parameter() {
  const Wind d;
  return group_parameter(
      "wind",
      {number_parameter("mean_speed_mps", "m/s", d.mean_speed_mps, 0, kStorm_mps,
                        "mean wind at reference_height_m above the ground"),
       number_parameter("from_deg", "deg", deg_from_rad(d.from_azimuth_rad), -360, 360,
                        "where the wind comes from, clockwise from north"),
       positive_parameter("reference_height_m", "m", d.reference_height_m,
                          "above the ground, of mean_speed_mps"),
       choice_parameter("height_law", "logarithmic", {"uniform", "logarithmic", "power", "linear"},
                        "how the mean wind grows with height"),
       positive_parameter("roughness_length_m", "m", d.roughness_length_m,
                          "of the logarithmic law, below reference_height_m: 0.03 grass, 0.1 low "
                          "crops, 0.25 high crops (Wieringa 1992)"),
       number_parameter("power_exponent", "", d.power_exponent, 0, 1, "of the power law"),
       number_parameter("ground_speed_mps", "m/s", d.ground_speed_mps, -kStorm_mps, kStorm_mps,
                        "of the linear law: wind at the ground; < 0 blows the other way"),
       number_parameter("turbulence", "", d.turbulence, 0, 10,
                        "factor on the Dryden turbulence of MIL-F-8785C, low altitude; 0: none"),
       optional(number_parameter("turbulence_wind_mps", "m/s", 0, 0, kStorm_mps,
                                 "wind at 20 ft that sets the turbulence; default: the mean wind "
                                 "there")),
       number_parameter("turbulence_limit_mps", "m/s", d.turbulence_limit_mps, 0, kStorm_mps,
                        "largest length of the turbulence's vector; 0: no limit"),
       group_list_parameter("gusts", gust_fields(), "1-cosine pulses at given times"),
       group_parameter("random_gusts", random_gust_fields(),
                       "1-cosine pulses at random times, the same for all vehicles"),
       number_parameter("shelter", "", d.shelter_attenuation, 0, 5,
                        "attenuation a of exp(-a (1 - z/top)) across the rows of a block; 0: "
                        "none, 1.2: vines of leaf area index 2 (Goudriaan 1977)"),
       choice_parameter("atmosphere", "constant", {"constant", "us76"},
                        "density everywhere alike, or US Standard Atmosphere 1976"),
       positive_parameter("air_density_kgm3", "kg/m3", d.air_density_kgm3,
                          "of a constant atmosphere")},
      "wind that every vehicle feels; absent: calm");
}

Wind read_wind(const ParameterSet& parameters, std::uint64_t seed) {
  Wind wind;
  if (!parameters.has("wind")) return wind;
  const ParameterSet& given = parameters.group("wind");
  if (given.text("atmosphere") == "us76") wind.atmosphere = Atmosphere::kStandard76;
  wind.air_density_kgm3 = given.number("air_density_kgm3");
  wind.mean_speed_mps = given.number("mean_speed_mps");
  wind.from_azimuth_rad = rad_from_deg(given.number("from_deg"));
  wind.reference_height_m = given.number("reference_height_m");
  wind.height_law = height_law_of(given.text("height_law"));
  wind.roughness_length_m = given.number("roughness_length_m");
  wind.power_exponent = given.number("power_exponent");
  wind.ground_speed_mps = given.number("ground_speed_mps");
  wind.turbulence = given.number("turbulence");
  if (given.has("turbulence_wind_mps")) {
    wind.turbulence_wind_mps = given.number("turbulence_wind_mps");
  }
  wind.turbulence_limit_mps = given.number("turbulence_limit_mps");
  for (const ParameterSet& pulse : given.groups("gusts")) {
    WindGust gust;
    gust.start_s = pulse.number("at_s");
    gust.duration_s = pulse.number("duration_s");
    gust.amplitude_mps = pulse.number("amplitude_mps");
    gust.from_azimuth_rad =
        pulse.has("from_deg") ? rad_from_deg(pulse.number("from_deg")) : wind.from_azimuth_rad;
    gust.vertical_mps = pulse.number("vertical_mps");
    gust.front_speed_mps = pulse.number("front_speed_mps");
    wind.gusts.push_back(gust);
  }
  if (given.has("random_gusts")) {
    const ParameterSet& random = given.group("random_gusts");
    wind.random_gust_interval_s = random.number("interval_s");
    wind.random_gust_amplitude_mps = random.number("amplitude_mps");
    wind.random_gust_duration_s = random.number("duration_s");
    wind.random_gust_seed = seed;
  }
  wind.shelter_attenuation = given.number("shelter");
  validate(wind);
  return wind;
}

}  // namespace vinerow::worlds
