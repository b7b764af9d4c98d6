#include "engine/io/clouds/point_cloud_crs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "engine/core/error.h"
#include "engine/io/geo/crs.h"
#include "engine/io/geo/quiet_gdal.h"
#include "engine/math/angles.h"
#include "engine/math/geo.h"

namespace vinerow::io {
namespace {

/// True for a valid longitude and latitude in degrees. PROJ returns infinity for positions that it
/// cannot transform, but passes all numbers through from WGS84 to WGS84.
bool is_on_earth(double x, double y) {
  return std::abs(x) <= 360.0 && std::abs(y) <= 90.0;
}

}  // namespace

EpsgCode find_epsg_code(const std::string& crs) {
  const QuietGdal quiet;
  const Crs parsed = parse_crs(crs);
  const char* authority = gdal().OSRGetAuthorityName(parsed.get(), nullptr);
  const char* code = gdal().OSRGetAuthorityCode(parsed.get(), nullptr);
  const int number = code == nullptr ? 0 : std::atoi(code);
  if (authority == nullptr || std::string(authority) != "EPSG" || number < 1024 ||
      number >= 32767 || parsed.is_compound() ||
      !(parsed.is_projected() || parsed.is_geographic())) {
    throw ConfigError(fmt::format(
        "crs = '{}' must be the EPSG code of a geographic or projected system, like EPSG:32632",
        crs.substr(0, 60)));
  }
  return {static_cast<std::uint16_t>(number), parsed.is_geographic()};
}

struct CloudFrame::Impl {
  Impl(const std::string& text, const GeoOrigin& origin) : frame(origin) {
    Crs crs = parse_crs(text);
    height_m = crs.height_unit_m();
    name = crs.name();
    // Heights are handled separately, so that PROJ does not apply a geoid if it has the grid.
    crs.strip_vertical();
    to_wgs84 = Transformation(crs, make_wgs84());
    if (!to_wgs84) {
      throw ConfigError(fmt::format("crs '{}' cannot be transformed to WGS84", name));
    }
  }

  LocalFrame frame;
  double height_m = 1.0;
  std::string name;
  Transformation to_wgs84;
};

CloudFrame::CloudFrame(const std::string& crs, const GeoOrigin& origin) {
  const QuietGdal quiet;
  impl_ = std::make_unique<Impl>(crs, origin);
}

CloudFrame::~CloudFrame() = default;

Eigen::Vector3d CloudFrame::to_local(const Eigen::Vector3d& position) const {
  const QuietGdal quiet;
  double x = position.x(), y = position.y();
  if (!impl_->to_wgs84.apply(x, y) || !is_on_earth(x, y)) {
    throw ConfigError(fmt::format("point ({}, {}, {}) is outside the area of the crs '{}'",
                                  position.x(), position.y(), position.z(), impl_->name));
  }
  return impl_->frame.to_local({rad_from_deg(y), rad_from_deg(x), impl_->height_m * position.z()});
}

void CloudFrame::to_local(std::span<CloudPoint> points) const {
  const QuietGdal quiet;
  constexpr std::size_t kBlock = 1024;
  std::array<double, kBlock> x, y;
  for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
    const std::span<CloudPoint> block =
        points.subspan(begin, std::min(kBlock, points.size() - begin));
    for (std::size_t k = 0; k < block.size(); ++k) {
      x[k] = block[k].position.x();
      y[k] = block[k].position.y();
    }
    // The check below finds points that could not be transformed and names them.
    impl_->to_wgs84.apply(block.size(), x.data(), y.data());
    for (std::size_t k = 0; k < block.size(); ++k) {
      Eigen::Vector3d& position = block[k].position;
      if (is_on_earth(x[k], y[k])) {
        position = impl_->frame.to_local(
            {rad_from_deg(y[k]), rad_from_deg(x[k]), impl_->height_m * position.z()});
      } else {
        position = to_local(position);
      }
    }
  }
}

bool looks_like_degrees(const Eigen::AlignedBox3d& bounds) {
  const Eigen::Vector3d max_abs = bounds.min().cwiseAbs().cwiseMax(bounds.max().cwiseAbs());
  const Eigen::Vector3d size = bounds.sizes();
  const double width = std::max(size.x(), size.y());
  return max_abs.x() <= 180.0 && max_abs.y() <= 90.0 && width > 0.0 && size.z() >= 20.0 * width;
}

void check_cloud_unit(const std::filesystem::path& file, const std::string& crs,
                      const Eigen::AlignedBox3d& bounds) {
  if (!looks_like_degrees(bounds)) return;
  std::string reason =
      "has no coordinate reference system; give it by --crs EPSG:<code> (EPSG:4326 for WGS84)";
  if (!crs.empty()) {
    const QuietGdal quiet;
    const Crs parsed = parse_crs(crs);
    if (parsed.is_geographic()) return;
    reason = fmt::format("its coordinate reference system '{}' is projected", parsed.name());
  }
  throw ConfigError(
      fmt::format("point cloud '{}' seems to be in degrees (x {} to {}, y {} to {}, z {} "
                  "to {}), but {}",
                  file.string(), bounds.min().x(), bounds.max().x(), bounds.min().y(),
                  bounds.max().y(), bounds.min().z(), bounds.max().z(), reason));
}

}  // namespace vinerow::io
