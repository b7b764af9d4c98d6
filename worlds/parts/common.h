#pragma once
/// Parameters common to all worlds: position on Earth, light, soil, wind.

#include <cstdint>
#include <string>

#include "engine/api/parameter_table_fwd.h"
#include "engine/api/wind.h"
#include "engine/api/world_model.h"
#include "engine/math/geo_origin.h"

namespace vinerow::worlds {

/// `origin_latitude_deg`, `origin_longitude_deg`, `origin_altitude_m`.
const ParameterTable<GeoOrigin>& origin_table();

struct Surroundings {
  std::string soil = "dry_grass";  ///< of soil_names()
  Daylight daylight;
  Wind wind;
};
/// `soil`, `sun_azimuth_deg`, `sun_elevation_deg`, `cloud_cover`, the group `wind`.
const ParameterTable<Surroundings>& surroundings_table();
/// @param seed  of the run, for random gusts
/// @throws ConfigError as find_soil()
void set_surroundings(const Surroundings& surroundings, std::uint64_t seed, WorldModel& world);

}  // namespace vinerow::worlds
