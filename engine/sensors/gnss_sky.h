#pragma once
/// Where the navigation satellites stand: two constellations on circular orbits.
///
/// Nominal slots, so that elevations and azimuths are as at the real place and time, though not
/// those of today's single satellites:
///   GPS      24 satellites in 6 planes, radius 26,559.7 km, inclination 55 deg. Slots: GPS SPS
///            Performance Standard 2001, table 3-1 (epoch 1993-07-01); the phase keeps the ground
///            track, two turns a day of the node
///   Galileo  Walker 24/3/1, radius 29,600.318 km, inclination 56 deg. Slots and rates: European
///            GNSS Service Centre, Galileo reference constellation (epoch 2010-03-21)
/// Left out: eccentricity, spares, GLONASS and BeiDou, the difference of UTC and UT1 (< 1 s).

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "engine/math/geo_origin.h"

namespace vinerow::sensors {

/// A circular orbit whose node and phase move evenly; instants in s since 2000-01-01 12:00 UTC.
struct CircularOrbit {
  double radius_m = 0.0;
  double inclination_rad = 0.0;
  double epoch_s = 0.0;
  double node_rad = 0.0;  ///< right ascension of the ascending node, at the epoch
  double node_rate_radps = 0.0;
  double phase_rad = 0.0;  ///< argument of latitude, at the epoch
  double phase_rate_radps = 0.0;

  /// In the frame that turns with the Earth: x through the equator at Greenwich, z through the
  /// north pole; m.
  Eigen::Vector3d position_E(double instant_s) const;
};

/// Greenwich's sidereal angle. @param instant_s  as above. Source: Meeus, Astronomical Algorithms,
/// eq. (12.4), linear part.
double sidereal_angle_rad(double instant_s);

/// "2024-06-15T10:00:00", UTC. @returns s since 2000-01-01 12:00 UTC
/// @param name  of the parameter, for errors  @throws ConfigError if it is no instant
double read_utc(std::string_view text, std::string_view name);

std::vector<CircularOrbit> gps_orbits();
std::vector<CircularOrbit> galileo_orbits();

/// The satellites as seen from a world's origin. Inside a world they all look the same: 1 km turns
/// none by more than 0.01 deg.
class GnssSky {
 public:
  /// @param start_s  the instant of simulated time zero
  GnssSky(const GeoOrigin& origin, std::vector<CircularOrbit> orbits, double start_s);

  std::size_t size() const { return orbits_.size(); }
  /// Towards a satellite, above or below the horizon; unit, in W. @param time_s  simulated
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

/// @param who  the sensor, for errors  @throws ConfigError for an unknown constellation, one given
/// twice, none, an epoch that is no date
GnssSky make_gnss_sky(const GnssSkyParams& params, const GeoOrigin& origin, const std::string& who);

}  // namespace vinerow::sensors
