#include "controllers/autopilot/frames/firmware_frame.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr double kEarthRadius_m = 6'378'100.0;  // ArduPilot's sphere
constexpr double kPx4EarthRadius_m = 6'371'000.0;
constexpr double kPerDegree = 1e7;

double rad_from_e7(std::int32_t angle) {
  return rad_from_deg(angle / kPerDegree);
}

/// A circle of latitude is shorter than the equator; ArduPilot takes the mean of both latitudes.
double east_radius_m(double latitude_rad, double other_rad) {
  return kEarthRadius_m * std::cos(0.5 * (latitude_rad + other_rad));
}

/// Inverse of the azimuthal equidistant projection about a point: distance c (as an angle) and
/// direction from it are true.
///   latitude = asin(cos c sin phi0 + n/c' sin c cos phi0)
///   longitude = lambda0 + atan2(e sin c, c' cos phi0 cos c - n sin phi0 sin c)
/// with c' the distance in metres over the radius, and n, e in the same unit.
Geodetic reproject(double latitude0, double longitude0, double north_m, double east_m) {
  const double n = north_m / kPx4EarthRadius_m, e = east_m / kPx4EarthRadius_m;
  const double c = std::hypot(n, e);
  if (c == 0.0) return {latitude0, longitude0, 0.0};
  const double sin0 = std::sin(latitude0), cos0 = std::cos(latitude0);
  const double sin_c = std::sin(c), cos_c = std::cos(c);
  return {std::asin(cos_c * sin0 + n * sin_c * cos0 / c),
          longitude0 + std::atan2(e * sin_c, c * cos0 * cos_c - n * sin0 * sin_c), 0.0};
}

}  // namespace

PlaceE7 FirmwareFrame::home() const {
  // --home is cut to whole units, not rounded.
  const GeoOrigin& origin = wgs84_.origin();
  return {static_cast<std::int32_t>(deg_from_rad(origin.latitude_rad) * kPerDegree),
          static_cast<std::int32_t>(deg_from_rad(origin.longitude_rad) * kPerDegree)};
}

std::string FirmwareFrame::home_text() const {
  const GeoOrigin& origin = wgs84_.origin();
  return fmt::format("{:.12f},{:.12f},{:.3f},0", deg_from_rad(origin.latitude_rad),
                     deg_from_rad(origin.longitude_rad), origin.altitude_m);
}

PlaceE7 FirmwareFrame::place_of(const Eigen::Vector3d& p_W) const {
  if (receiver_ != Receiver::kOfFirmware) {
    return io::place_e7(wgs84_.to_geodetic(p_W));
  }
  const double latitude0 = rad_from_e7(home().latitude);
  const double latitude = latitude0 + p_W.y() / kEarthRadius_m;
  const double longitude =
      rad_from_e7(home().longitude) + p_W.x() / east_radius_m(latitude, latitude0);
  return io::place_e7({latitude, longitude, 0.0});
}

Eigen::Vector3d FirmwareFrame::local_to_W(const PlaceE7& ekf_origin, double altitude_m,
                                          const Eigen::Vector3d& p_NED) const {
  const double latitude0 = rad_from_e7(ekf_origin.latitude);
  const double up_m = altitude_m - wgs84_.origin().altitude_m - p_NED.z();
  if (receiver_ == Receiver::kOursInPx4) {
    Geodetic place = reproject(latitude0, rad_from_e7(ekf_origin.longitude), p_NED.x(), p_NED.y());
    place.altitude_m = altitude_m - p_NED.z();
    return wgs84_.to_local(place);
  }
  if (receiver_ == Receiver::kOurs) {
    Geodetic place;
    place.latitude_rad = latitude0 + p_NED.x() / kEarthRadius_m;
    place.longitude_rad = rad_from_e7(ekf_origin.longitude) +
                          p_NED.y() / east_radius_m(place.latitude_rad, latitude0);
    place.altitude_m = altitude_m - p_NED.z();
    return wgs84_.to_local(place);
  }
  const double home_rad = rad_from_e7(home().latitude);
  const double north_m = (latitude0 - home_rad) * kEarthRadius_m;
  const double east_m = (rad_from_e7(ekf_origin.longitude) - rad_from_e7(home().longitude)) *
                        east_radius_m(latitude0, home_rad);
  return {east_m + p_NED.y(), north_m + p_NED.x(), up_m};
}

}  // namespace vinerow::controllers
