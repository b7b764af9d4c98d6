#pragma once
/// Latitudes and longitudes as an autopilot's firmware has them.
///
/// ArduPilot's simulated receiver places the vehicle on a sphere around home. There the same metres
/// north are another difference of latitude than on WGS84: at 45 degrees 0.17 %, so a waypoint
/// 100 m away would be missed by 17 cm, which is much between rows of vines. So all places that go
/// to the firmware and come from it are converted as its receiver does. If it gets the readings of
/// our own receiver instead, its latitudes are those of WGS84. PX4 always gets ours; its local
/// coordinates are an azimuthal equidistant projection of another sphere.
///
/// Source: ArduPilot 4.6.3, Location::offset_latlng, Location::get_distance_NE,
/// SITL_State::parse_home; PX4 1.14.3, MapProjection::reproject.

#include <Eigen/Core>
#include <string>

#include "engine/io/missions/mission_items.h"
#include "engine/math/geo.h"

namespace vinerow::controllers {

using io::PlaceE7;  // ArduPilot computes with these numbers

class FirmwareFrame {
 public:
  enum class Receiver {
    kOfFirmware,  ///< simulated by the firmware from the position in W
    kOurs,        ///< readings of a sensor of the vehicle
    kOursInPx4    ///< the same, but local coordinates are PX4's
  };

  FirmwareFrame(const GeoOrigin& origin, Receiver receiver) : wgs84_(origin), receiver_(receiver) {}

  /// "latitude,longitude,altitude,heading" of W's origin, as ArduPilot's option --home reads it.
  std::string home_text() const;
  PlaceE7 place_of(const Eigen::Vector3d& p_W) const;
  /// A place of a map, as a mission file has it.
  PlaceE7 place_of(const Geodetic& point) const { return place_of(wgs84_.to_local(point)); }
  /// @param ekf_origin   where the firmware's local coordinates begin
  /// @param altitude_m   of that point
  /// @param p_NED        in these coordinates, m
  /// @returns m in W
  Eigen::Vector3d local_to_W(const PlaceE7& ekf_origin, double altitude_m,
                             const Eigen::Vector3d& p_NED) const;
  const LocalFrame& wgs84() const { return wgs84_; }

 private:
  PlaceE7 home() const;

  LocalFrame wgs84_;
  Receiver receiver_;
};

}  // namespace vinerow::controllers
