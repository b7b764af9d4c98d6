#include "controllers/autopilot/frames/firmware_frame.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

constexpr double kEarthRadius_m = 6'378'100.0;  // ArduPilot's sphere
constexpr double kPerDegree = 1e7;

double rad_from_e7(std::int32_t angle) {
  return rad_from_deg(angle / kPerDegree);
}

/// A circle of latitude is shorter than the equator; ArduPilot takes the mean of both latitudes.
double east_radius_m(double latitude_rad, double other_rad) {
  return kEarthRadius_m * std::cos(0.5 * (latitude_rad + other_rad));
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
  if (receiver_ == Receiver::kOurs) {
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
