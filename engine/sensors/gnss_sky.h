#pragma once
/// Positions of navigation satellites: two constellations on circular orbits.
///
/// Nominal slots: elevations and azimuths are typical of the real place and time, but not those of
/// today's individual satellites.
///   GPS      24 satellites in 6 planes, radius 26,559.7 km, inclination 55 deg. Slots: GPS SPS
///            Performance Standard 2001, table 3-1 (epoch 1993-07-01); the phase makes two
///            turns per turn of the Earth relative to the node: the ground track repeats
///   Galileo  Walker 24/3/1, radius 29,600.318 km, inclination 56 deg. Slots and rates: European
///            GNSS Service Centre, Galileo reference constellation (epoch 2010-03-21)
/// Not modelled: eccentricity, spares, GLONASS and BeiDou, the difference of UTC and UT1 (< 1 s).

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "engine/math/geo_origin.h"

namespace vinerow::sensors {

/// Circular orbit whose node and phase change linearly; instants in s since 2000-01-01 12:00 UTC.
struct CircularOrbit {
  double radius_m = 0.0;
  double inclination_rad = 0.0;
  double epoch_s = 0.0;
  double node_rad = 0.0;  ///< right ascension of the ascending node, at the epoch
  double node_rate_radps = 0.0;
  double phase_rad = 0.0;  ///< argument of latitude, at the epoch
  double phase_rate_radps = 0.0;

  /// Position in the Earth-fixed frame: x through the equator at Greenwich, z through the north
  /// pole; m.
  Eigen::Vector3d position_E(double instant_s) const;
};

/// Greenwich sidereal angle. @param instant_s  as above. Source: Meeus, Astronomical Algorithms,
/// eq. (12.4), linear part.
double sidereal_angle_rad(double instant_s);

/// Parses "2024-06-15T10:00:00", UTC. @returns s since 2000-01-01 12:00 UTC
/// @param name  of the parameter, for errors
/// @throws ConfigError if the text is not a date and time
double read_utc(std::string_view text, std::string_view name);

std::vector<CircularOrbit> gps_orbits();
std::vector<CircularOrbit> galileo_orbits();

/// Directions to the satellites from a world's origin. They are the same everywhere in a world: 1
/// km changes none by more than 0.01 deg.
class GnssSky {
 public:
  /// @param start_s  the instant of simulated time zero
  GnssSky(const GeoOrigin& origin, std::vector<CircularOrbit> orbits, double start_s);

  std::size_t size() const { return orbits_.size(); }
  /// Direction to a satellite, above or below the horizon; unit, in W. @param time_s  simulated
  Eigen::Vector3d direction_W(std::size_t satellite, double time_s) const;

 private:
  std::vector<CircularOrbit> orbits_;
  double start_s_;
  Eigen::Vector3d origin_E_;
  Eigen::Matrix3d R_WE_;
};

struct GnssSkyParams {
  std::vector<std::string> constellations = {"gps", "galileo"};
  std::string epoch_utc = "2024-06-15T10:00:00";
};

/// `constellations`, `epoch_utc`
const ParameterTable<GnssSkyParams>& gnss_sky_table();

/// @param who  the sensor, for errors
/// @throws ConfigError for an unknown constellation, one given twice, an empty list, or an invalid
/// epoch
GnssSky make_gnss_sky(const GnssSkyParams& params, const GeoOrigin& origin, const std::string& who);

}  // namespace vinerow::sensors
