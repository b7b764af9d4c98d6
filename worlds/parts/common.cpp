#include "worlds/parts/common.h"

#include "engine/api/world_model.h"
#include "engine/math/angles.h"
#include "worlds/parts/soil.h"
#include "worlds/parts/wind.h"

namespace vinerow::worlds {

std::vector<ParameterSpec> origin_parameters(double latitude_deg, double longitude_deg,
                                             double altitude_m) {
  return {number_parameter("origin_latitude_deg", "deg", latitude_deg, -90, 90,
                           "WGS84 latitude of the world's origin"),
          number_parameter("origin_longitude_deg", "deg", longitude_deg, -180, 180,
                           "WGS84 longitude of the world's origin"),
          number_parameter("origin_altitude_m", "m", altitude_m, -500, 9000,
                           "altitude of the world's z = 0")};
}

GeoOrigin read_origin(const ParameterSet& parameters, const GeoOrigin& otherwise) {
  GeoOrigin origin = otherwise;
  if (parameters.has("origin_latitude_deg")) {
    origin.latitude_rad = rad_from_deg(parameters.number("origin_latitude_deg"));
  }
  if (parameters.has("origin_longitude_deg")) {
    origin.longitude_rad = rad_from_deg(parameters.number("origin_longitude_deg"));
  }
  if (parameters.has("origin_altitude_m")) {
    origin.altitude_m = parameters.number("origin_altitude_m");
  }
  return origin;
}

std::vector<ParameterSpec> surroundings_parameters() {
  const Daylight light;
  return {soil_parameter("dry_grass"),
          number_parameter("sun_azimuth_deg", "deg", deg_from_rad(light.sun_azimuth_rad), -360, 360,
                           "direction of the sun, from north clockwise"),
          number_parameter("sun_elevation_deg", "deg", deg_from_rad(light.sun_elevation_rad), 1, 90,
                           "height of the sun above the horizon"),
          wind_parameter()};
}

void read_surroundings(const ParameterSet& parameters, std::uint64_t seed, WorldModel& world) {
  world.soil = find_soil(parameters.text("soil"));
  world.daylight.sun_azimuth_rad = rad_from_deg(parameters.number("sun_azimuth_deg"));
  world.daylight.sun_elevation_rad = rad_from_deg(parameters.number("sun_elevation_deg"));
  world.wind = read_wind(parameters, seed);
  const bool without_wind =
      world.wind.mean_speed_mps == 0.0 && world.wind.turbulence_wind_mps <= 0.0;
  if (world.wind.turbulence > 0.0 && without_wind) {
    world.notes.emplace_back(
        "wind.turbulence has no wind to scale with and is left out; give wind.mean_speed_mps or "
        "wind.turbulence_wind_mps");
  }
}

std::vector<ParameterSpec> concatenate(std::vector<std::vector<ParameterSpec>> lists) {
  std::vector<ParameterSpec> all;
  for (auto& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

}  // namespace vinerow::worlds
