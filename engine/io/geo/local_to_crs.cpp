#include "engine/io/geo/local_to_crs.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/io/geo/crs.h"
#include "engine/io/geo/quiet_gdal.h"
#include "engine/math/angles.h"
#include "engine/math/geo.h"

namespace vinerow::io {

struct LocalToCrs::Impl {
  Impl(const std::string& text, const GeoOrigin& origin) : frame(origin) {
    Crs crs = parse_crs(text);
    name = crs.name();
    height_m = crs.height_unit_m();
    crs.strip_vertical();
    from_wgs84 = Transformation(make_wgs84(), crs);
    if (!from_wgs84) {
      throw ConfigError(fmt::format("WGS84 cannot be transformed to the crs '{}'", name));
    }
  }

  LocalFrame frame;
  double height_m = 1.0;  ///< unit of z in metres
  std::string name;
  Transformation from_wgs84;
};

LocalToCrs::LocalToCrs(const std::string& crs, const GeoOrigin& origin) {
  const QuietGdal quiet;
  impl_ = std::make_unique<Impl>(crs, origin);
}

LocalToCrs::~LocalToCrs() = default;

Eigen::Vector3d LocalToCrs::from_local(const Eigen::Vector3d& p_W) const {
  const QuietGdal quiet;
  const Geodetic place = impl_->frame.to_geodetic(p_W);
  double x = deg_from_rad(place.longitude_rad), y = deg_from_rad(place.latitude_rad);
  const double longitude = x, latitude = y;
  if (!impl_->from_wgs84.apply(x, y) || !std::isfinite(x) || !std::isfinite(y)) {
    throw ConfigError(
        fmt::format("the position {:.6f} N, {:.6f} E is outside the area of the crs '{}'", latitude,
                    longitude, impl_->name));
  }
  return {x, y, place.altitude_m / impl_->height_m};
}

LocalToCrs::Nearby LocalToCrs::near(const Eigen::Vector3d& centre_W) const {
  constexpr double kStep_m = 10.0;
  Nearby nearby;
  nearby.centre_W = centre_W;
  nearby.constant = from_local(centre_W);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kStep_m * Eigen::Vector3d::Unit(axis);
    nearby.linear.col(axis) =
        (from_local(centre_W + step) - from_local(centre_W - step)) / (2.0 * kStep_m);
  }
  return nearby;
}

}  // namespace vinerow::io
