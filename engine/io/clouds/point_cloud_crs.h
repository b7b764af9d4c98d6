#pragma once
/// The coordinate reference systems of point clouds, and the way from them to W.

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

/// @param crs  "EPSG:25832". @throws ConfigError for anything but a two-dimensional geographic or a
/// projected system that PROJ knows
EpsgCode find_epsg_code(const std::string& crs);

/// Brings coordinates of a CRS to W: x is easting or longitude, y northing or latitude (in the
/// CRS's unit, degrees for geographic ones), whatever the authority's own order is.
///
/// Heights: z in the unit of the CRS's vertical part where it has one, else of a projected CRS,
/// else metres. No geoid is applied: give the origin's altitude in the cloud's height system, as
/// for rasters (raster.h). Not thread safe.
class CloudFrame {
 public:
  /// @param crs  "EPSG:25832", "EPSG:25832+7837", WKT, or what else PROJ reads
  /// @throws ConfigError: `crs` is unknown, or does not convert to WGS84
  CloudFrame(const std::string& crs, const GeoOrigin& origin);
  ~CloudFrame();

  /// @returns m in W. @throws ConfigError naming the coordinates where the CRS has no such place
  Eigen::Vector3d to_local(const Eigen::Vector3d& position) const;
  void to_local(std::span<CloudPoint> points) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// True where the horizontal numbers can be degrees and make no sense as metres: within +-180 and
/// +-90, and the cloud at least 20 times as high as it is wide.
bool looks_like_degrees(const Eigen::AlignedBox3d& bounds);

/// Refuses a cloud whose coordinates look like degrees, though it has no CRS or a projected one.
/// @param bounds  of the points, not the header's word. @throws ConfigError naming the file, the
/// numbers and the way out; unknown `crs`
void check_cloud_unit(const std::filesystem::path& file, const std::string& crs,
                      const Eigen::AlignedBox3d& bounds);

}  // namespace vinerow::io
