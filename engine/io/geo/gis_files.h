#pragma once
/// Writers of GIS files: GeoTIFF rasters in any coordinate reference system, and GeoPackages with
/// one layer per kind of feature.

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "engine/io/geo/geojson.h"

namespace vinerow::io {

/// Heights on a pixel grid of a CRS, northern row first.
struct CrsRaster {
  std::string crs;  ///< "EPSG:25832", WKT, or another form that PROJ reads; "": local metres
  int columns = 0, rows = 0;
  double cell = 0.0;           ///< pixel size in the CRS's unit
  Eigen::Vector2d north_west;  ///< outer corner of the first pixel
  std::vector<float> values;   ///< kNoHeight: unknown
  std::string description;     ///< of the band, whose unit is the metre

  static constexpr float kNoHeight = -9999.0f;
};

/// Writes one band of float32, deflated, with kNoHeight for pixels without a height.
/// @throws ConfigError if the file cannot be written (with its name) or the CRS is unknown
void write_crs_raster(const CrsRaster& raster, const std::filesystem::path& file);

using GisValue = std::variant<std::int64_t, double, std::string>;

struct GisFeature {
  std::vector<Eigen::Vector3d> points;  ///< easting or longitude first; the outer ring of a polygon
  std::vector<GisValue> values;         ///< one per field of the layer, of the field's kind
};

struct GisLayer {
  std::string name;
  GeometryKind kind = GeometryKind::kPoint;
  std::vector<std::string> fields;
  std::vector<GisFeature> features;  ///< not empty; the first defines the kinds of fields
};

/// Writes a GeoPackage. Equal layers give equal bytes.
/// @param crs  as in CrsRaster
/// @throws ConfigError if the file cannot be written (with its name) or the CRS is unknown
void write_geopackage(const std::vector<GisLayer>& layers, const std::string& crs,
                      const std::filesystem::path& file);

}  // namespace vinerow::io
