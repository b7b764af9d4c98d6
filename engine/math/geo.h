#pragma once
/// WGS84 and the local East-North-Up frame W of a scenario (GeographicLib's LocalCartesian).

#include <Eigen/Core>
#include <memory>

#include "engine/math/geo_origin.h"

namespace vinerow {

/// A point on or above the WGS84 ellipsoid.
struct Geodetic {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double altitude_m = 0.0;  ///< above the ellipsoid
};

/// Conversion between WGS84 and W: x east, y north, z up at the origin, straight axes (no map
/// projection). The ground therefore falls away by d^2 / 2R: 0.8 mm at 100 m.
///
/// Source: GeographicLib 2.1 LocalCartesian, after a rotation of geocentric coordinates. Thread
/// safe, no heap after construction.
class LocalFrame {
 public:
  /// @throws ConfigError if latitude or longitude is outside +-90 deg, +-180 deg or not finite
  explicit LocalFrame(const GeoOrigin& origin);
  ~LocalFrame();
  LocalFrame(const LocalFrame&);
  LocalFrame& operator=(const LocalFrame&);

  /// @returns m in W
  Eigen::Vector3d to_local(const Geodetic& point) const;
  Geodetic to_geodetic(const Eigen::Vector3d& p_W) const;
  const GeoOrigin& origin() const { return origin_; }

 private:
  struct Impl;
  GeoOrigin origin_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow
