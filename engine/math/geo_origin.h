#pragma once
/// Position of the world frame on Earth.

namespace vinerow {

/// Position of W's origin on the WGS84 ellipsoid.
struct GeoOrigin {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double altitude_m = 0.0;  ///< above the ellipsoid
};

}  // namespace vinerow
