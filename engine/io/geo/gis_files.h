#pragma once
/// What programs of surveyors open: GeoTIFF rasters in any coordinate reference system, GeoPackages
/// with a layer for each kind of feature.

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "engine/io/geo/geojson.h"

namespace vinerow::io {

/// Heights on pixels of a CRS, the northern row first.
struct CrsRaster {
  std::string crs;  ///< "EPSG:25832", WKT, or what else PROJ reads; "": local metres
  int columns = 0, rows = 0;
  double cell = 0.0;           ///< of a pixel, in the CRS's unit
  Eigen::Vector2d north_west;  ///< outer corner of the first pixel
  std::vector<float> values;   ///< kNoHeight: not known
  std::string description;     ///< of the band, whose unit is the metre

  static constexpr float kNoHeight = -9999.0f;
};

/// One band of float32, deflated, with kNoHeight for pixels without a height.
/// @throws ConfigError naming the file where it cannot be written; an unknown CRS
void write_crs_raster(const CrsRaster& raster, const std::filesystem::path& file);

using GisValue = std::variant<std::int64_t, double, std::string>;

struct GisFeature {
  std::vector<Eigen::Vector3d> points;  ///< easting or longitude first; of a polygon its outer ring
  std::vector<GisValue> values;         ///< as many as the layer's fields, of their kinds
};

struct GisLayer {
  std::string name;
  GeometryKind kind = GeometryKind::kPoint;
  std::vector<std::string> fields;
  std::vector<GisFeature> features;  ///< at least one: its values say what kinds the fields are
};

/// A GeoPackage of one layer per kind of feature; same layers, same bytes.
/// @param crs  as of CrsRaster
/// @throws ConfigError naming the file where it cannot be written; an unknown CRS
void write_geopackage(const std::vector<GisLayer>& layers, const std::string& crs,
                      const std::filesystem::path& file);

}  // namespace vinerow::io
