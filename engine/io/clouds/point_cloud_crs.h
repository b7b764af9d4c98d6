#pragma once
/// Coordinate reference systems of point clouds, and the transformation to W.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "engine/io/clouds/point_cloud.h"
#include "engine/math/geo_origin.h"

namespace vinerow::io {

struct EpsgCode {
  std::uint16_t code = 0;
  bool is_geographic = false;  ///< latitude and longitude; else projected
};

/// @param crs  "EPSG:25832". @throws ConfigError unless it is a two-dimensional geographic or
/// projected system that PROJ knows
EpsgCode find_epsg_code(const std::string& crs);

/// Transformation from a CRS to W. x is easting or longitude, y northing or latitude, in the CRS's
/// unit (degrees for geographic systems), regardless of the authority's axis order.
///
/// Heights: z is in the unit of the CRS's vertical part, else of the projected CRS, else in metres.
/// No geoid is applied: give the origin's altitude in the cloud's height system, as for rasters
/// (raster.h). Not thread safe.
class CloudFrame {
 public:
  /// @param crs  "EPSG:25832", "EPSG:25832+7837", WKT, or another form that PROJ reads
  /// @throws ConfigError: `crs` is unknown, or does not convert to WGS84
  CloudFrame(const std::string& crs, const GeoOrigin& origin);
  ~CloudFrame();

  /// @returns m in W. @throws ConfigError naming the coordinates if they cannot be transformed
  Eigen::Vector3d to_local(const Eigen::Vector3d& position) const;
  void to_local(std::span<CloudPoint> points) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// True if the horizontal coordinates look like degrees, not metres: they are within +-180 and
/// +-90, and the cloud is at least 20 times as high as it is wide.
bool looks_like_degrees(const Eigen::AlignedBox3d& bounds);

/// Rejects a cloud whose coordinates look like degrees although it has no CRS or a projected one.
/// @param bounds  of the points themselves, not the header's. @throws ConfigError naming the file,
/// the numbers and the remedy; also if `crs` is unknown
void check_cloud_unit(const std::filesystem::path& file, const std::string& crs,
                      const Eigen::AlignedBox3d& bounds);

}  // namespace vinerow::io
