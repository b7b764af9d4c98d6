#pragma once
/// Parameters that all worlds share: place on Earth, light, soil, wind.

#include <cstdint>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/geo_origin.h"
#include "engine/api/parameters.h"

namespace vinerow::worlds {

/// `origin_latitude_deg`, `origin_longitude_deg`, `origin_altitude_m`.
std::vector<ParameterSpec> origin_parameters(double latitude_deg, double longitude_deg,
                                             double altitude_m);
/// @throws ConfigError never: ranges are in the specs. Where latitude or longitude is absent the
/// given one counts.
GeoOrigin read_origin(const ParameterSet& parameters, const GeoOrigin& otherwise = {});

/// `soil`, `sun_azimuth_deg`, `sun_elevation_deg`, the group `wind`.
std::vector<ParameterSpec> surroundings_parameters();
/// @param seed  of the run, for gusts by chance
/// @throws ConfigError as read_wind()
void read_surroundings(const ParameterSet& parameters, std::uint64_t seed, WorldModel& world);

/// Lists joined in order.
std::vector<ParameterSpec> concatenate(std::vector<std::vector<ParameterSpec>> lists);

}  // namespace vinerow::worlds
