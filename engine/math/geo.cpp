#include "engine/math/geo.h"

#include <fmt/format.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <cmath>

#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow {

struct LocalFrame::Impl {
  GeographicLib::LocalCartesian projection;
};

LocalFrame::LocalFrame(const GeoOrigin& origin) : origin_(origin) {
  const double latitude_deg = deg_from_rad(origin.latitude_rad);
  const double longitude_deg = deg_from_rad(origin.longitude_rad);
  if (!(std::abs(latitude_deg) <= 90.0) || !(std::abs(longitude_deg) <= 180.0) ||
      !std::isfinite(origin.altitude_m)) {
    throw ConfigError(
        fmt::format("origin at latitude {} deg, longitude {} deg, altitude {} m: latitude must be "
                    "within +-90 deg, "
                    "longitude within +-180 deg",
                    latitude_deg, longitude_deg, origin.altitude_m));
  }
  impl_ = std::make_unique<Impl>(
      Impl{GeographicLib::LocalCartesian(latitude_deg, longitude_deg, origin.altitude_m)});
}

LocalFrame::~LocalFrame() = default;

LocalFrame::LocalFrame(const LocalFrame& other)
    : origin_(other.origin_), impl_(std::make_unique<Impl>(*other.impl_)) {}

LocalFrame& LocalFrame::operator=(const LocalFrame& other) {
  origin_ = other.origin_;
  *impl_ = *other.impl_;
  return *this;
}

Eigen::Vector3d LocalFrame::to_local(const Geodetic& point) const {
  Eigen::Vector3d p_W;
  impl_->projection.Forward(deg_from_rad(point.latitude_rad), deg_from_rad(point.longitude_rad),
                            point.altitude_m, p_W.x(), p_W.y(), p_W.z());
  return p_W;
}

Geodetic LocalFrame::to_geodetic(const Eigen::Vector3d& p_W) const {
  double latitude_deg, longitude_deg, altitude_m;
  impl_->projection.Reverse(p_W.x(), p_W.y(), p_W.z(), latitude_deg, longitude_deg, altitude_m);
  return {rad_from_deg(latitude_deg), rad_from_deg(longitude_deg), altitude_m};
}

}  // namespace vinerow
