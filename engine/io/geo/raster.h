#pragma once
/// Reader of elevation models (GeoTIFF and other GDAL rasters), resampled to a height field in W.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/height_field.h"
#include "engine/math/geo_origin.h"

namespace vinerow::io {

/// Heights as in the file: row 0 is the file's first (usually northern) row.
struct ElevationRaster {
  int columns = 0;
  int rows = 0;
  std::vector<float> heights_m;  ///< rows * columns, x fastest; NaN for "no data"
  /// Affine map from pixel to CRS: x = g[0] + column g[1] + row g[2], y = g[3] + column g[4] + row
  /// g[5]; (0, 0) is the outer corner of the first pixel, its centre is at (0.5, 0.5).
  double geo_transform[6] = {0, 1, 0, 0, 0, -1};
  std::string crs_wkt;   ///< coordinate reference system
  std::string crs_name;  ///< "CH1903 / LV03", for messages
  std::filesystem::path file;
};

/// Reads band 1. Heights in feet become metres if the file names this unit.
/// @param crs  "EPSG:21781": replaces the file's own CRS; "" uses the file's
/// @throws ConfigError naming the file: missing, not a raster, without georeference, without CRS
/// ("... has no
///         coordinate reference system; give it by 'crs: EPSG:<code>'"), unknown `crs`
ElevationRaster read_elevation(const std::filesystem::path& file, const std::string& crs = "");

/// Area and resolution of the requested height field.
struct FieldExtent {
  Eigen::Vector2d corner_W = {0, 0};  ///< south-west
  double width_m = 0.0;               ///< > 0
  double depth_m = 0.0;               ///< > 0
  double cell_m = 0.5;                ///< > 0
};

/// Resamples the raster bilinearly between pixel centres. Sample positions are transformed W ->
/// WGS84 -> raster CRS.
///
/// Heights are relative to the origin's altitude: h_W = h_raster - origin.altitude_m, minus the
/// ellipsoid's drop below the tangent plane. No geoid is applied: give the origin's altitude in the
/// raster's height system.
/// @throws ConfigError if the extent leaves the raster, naming the position, the raster's bounds
/// and its middle; if it contains "no data", or heights that no ground has
HeightField resample_elevation(const ElevationRaster& raster, const GeoOrigin& origin,
                               const FieldExtent& extent);

/// Bilinear height at WGS84 positions, m in the raster's height system.
class ElevationLookup {
 public:
  /// @throws ConfigError if WGS84 cannot be transformed to the raster's CRS
  explicit ElevationLookup(ElevationRaster raster);
  ~ElevationLookup();
  /// nullopt outside the raster and at "no data".
  std::optional<double> height_m(double latitude_rad, double longitude_rad) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow::io
