#pragma once
/// Where the world frame is on Earth.

namespace vinerow {

/// Where W's origin is on the WGS84 ellipsoid.
struct GeoOrigin {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double altitude_m = 0.0;  ///< above the ellipsoid
};

}  // namespace vinerow
