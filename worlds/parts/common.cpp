#include "worlds/parts/common.h"

#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "worlds/parts/soil_types.h"

namespace vinerow::worlds {

const ParameterTable<GeoOrigin>& origin_table() {
  using P = GeoOrigin;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .degrees("origin_latitude_deg", &P::latitude_rad, between(-90.0, 90.0),
                   "WGS84 latitude of the world's origin")
          .degrees("origin_longitude_deg", &P::longitude_rad, between(-180.0, 180.0),
                   "WGS84 longitude of the world's origin")
          .number("origin_altitude_m", "m", &P::altitude_m, between(-500.0, 9000.0),
                  "altitude of the world's z = 0");
  return table;
}

const ParameterTable<Surroundings>& surroundings_table() {
  using P = Surroundings;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("soil", &P::soil, "soil under the wheels: friction and rolling resistance by name")
          .one_of(soil_names())
          .degrees("sun_azimuth_deg", inside(&P::daylight, &Daylight::sun_azimuth_rad),
                   between(-360.0, 360.0), "direction of the sun, from north clockwise")
          .degrees("sun_elevation_deg", inside(&P::daylight, &Daylight::sun_elevation_rad),
                   between(2.1, 90.0), "height of the sun above the horizon")
          .number("cloud_cover", "", inside(&P::daylight, &Daylight::cloud_cover),
                  between(0.0, 1.0), "share of the sky: 0 clear, 1 overcast, without shadows")
          .group("wind", &P::wind, wind_table(), "wind on all vehicles; absent: calm");
  return table;
}

void set_surroundings(const Surroundings& surroundings, std::uint64_t seed, WorldModel& world) {
  world.soil = find_soil(surroundings.soil);
  world.daylight = surroundings.daylight;
  world.wind = surroundings.wind;
  if (world.wind.random_gusts) world.wind.random_gusts->seed = seed;
  const bool without_wind =
      world.wind.mean_speed_mps == 0.0 && world.wind.turbulence_wind_mps.value_or(0.0) == 0.0;
  if (world.wind.turbulence > 0.0 && without_wind) {
    world.notes.emplace_back(
        "wind.turbulence has no wind to scale with and is left out; give wind.mean_speed_mps or "
        "wind.turbulence_wind_mps");
  }
}

}  // namespace vinerow::worlds
