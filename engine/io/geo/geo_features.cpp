#include "engine/io/geo/geo_features.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/io/files/yaml.h"
#include "engine/io/geo/crs.h"
#include "engine/io/geo/gdal_handles.h"
#include "engine/io/geo/quiet_gdal.h"
#include "engine/math/angles.h"

namespace vinerow::io {
namespace {

bool is_read_by_gdal(const std::filesystem::path& file) {
  const std::string ending = lower_extension(file);
  return ending == ".kml" || ending == ".kmz" || ending == ".shp" || ending == ".gpkg";
}

std::string in_lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Reader of the features of one layer.
class LayerReader {
 public:
  LayerReader(const std::filesystem::path& file, OGRLayerH layer, std::vector<GeoFeature>& features)
      : file_(file), layer_(layer), features_(features) {
    const OGRSpatialReferenceH own = gdal().OGR_L_GetSpatialRef(layer);
    if (is_georeferenced(own)) to_wgs84_ = Transformation(Crs(own), make_wgs84());
  }

  void read() {
    gdal().OGR_L_ResetReading(layer_);
    while (const FeatureHandle source{gdal().OGR_L_GetNextFeature(layer_)}) {
      GeoFeature feature;
      feature.index = index_ = static_cast<int>(next_index_++);
      for (int i = 0; i < gdal().OGR_F_GetFieldCount(source.get()); ++i) {
        if (!gdal().OGR_F_IsFieldSetAndNotNull(source.get(), i)) continue;
        const OGRFieldDefnH field = gdal().OGR_F_GetFieldDefnRef(source.get(), i);
        feature.properties[in_lower_case(gdal().OGR_Fld_GetNameRef(field))] =
            gdal().OGR_F_GetFieldAsString(source.get(), i);
      }
      if (const OGRGeometryH geometry = gdal().OGR_F_GetGeometryRef(source.get())) {
        add(geometry, feature, 0);
      }
    }
  }

 private:
  [[noreturn]] void fail(const std::string& sentence) const {
    throw ConfigError(fmt::format("'{}', feature {}: {}", file_.string(), index_, sentence));
  }

  Geodetic convert(double x, double y, double z) const {
    if (!to_wgs84_) {
      fail(
          "its layer has no coordinate reference system; a shapefile needs a .prj file with "
          "it in the same folder");
    }
    double longitude_deg = x, latitude_deg = y;
    const bool is_good =
        std::isfinite(x) && std::isfinite(y) && to_wgs84_.apply(longitude_deg, latitude_deg);
    if (!is_good || !(std::abs(longitude_deg) <= 180.0) || !(std::abs(latitude_deg) <= 90.0)) {
      fail(fmt::format("the coordinate ({}, {}) is not a valid position", x, y));
    }
    return {rad_from_deg(latitude_deg), rad_from_deg(longitude_deg), std::isfinite(z) ? z : 0.0};
  }

  Geodetic position(OGRGeometryH geometry, int i) const {
    return convert(gdal().OGR_G_GetX(geometry, i), gdal().OGR_G_GetY(geometry, i),
                   gdal().OGR_G_GetZ(geometry, i));
  }

  void add_points(OGRGeometryH line, GeometryKind kind, GeoFeature feature) {
    feature.kind = kind;
    feature.has_altitude = gdal().OGR_G_Is3D(line) != 0;
    for (int i = 0; i < gdal().OGR_G_GetPointCount(line); ++i) {
      feature.points.push_back(position(line, i));
    }
    if (feature.points.size() < 2) {
      fail(fmt::format("a line needs at least 2 points, it has {}", feature.points.size()));
    }
    features_.push_back(std::move(feature));
  }

  void add(OGRGeometryH geometry, const GeoFeature& feature, int depth) {
    constexpr int kDeepest = 32;
    if (depth > kDeepest) fail("its geometry is nested too deeply");
    if (gdal().OGR_G_IsEmpty(geometry)) return;
    switch (gdal().OGR_GT_Flatten(gdal().OGR_G_GetGeometryType(geometry))) {
      case wkbPoint: {
        GeoFeature one = feature;
        one.kind = GeometryKind::kPoint;
        one.has_altitude = gdal().OGR_G_Is3D(geometry) != 0;
        one.points = {position(geometry, 0)};
        features_.push_back(std::move(one));
        return;
      }
      case wkbLineString:
        add_points(geometry, GeometryKind::kLineString, feature);
        return;
      case wkbPolygon: {
        const OGRGeometryH ring = gdal().OGR_G_GetGeometryRef(geometry, 0);
        if (ring == nullptr) fail("a polygon needs an outer ring");
        add_points(ring, GeometryKind::kPolygon, feature);
        return;
      }
      case wkbMultiPoint:
      case wkbMultiLineString:
      case wkbMultiPolygon:
      case wkbGeometryCollection:
        for (int i = 0; i < gdal().OGR_G_GetGeometryCount(geometry); ++i) {
          add(gdal().OGR_G_GetGeometryRef(geometry, i), feature, depth + 1);
        }
        return;
      default:
        fail(fmt::format("unknown geometry '{}'", gdal().OGR_G_GetGeometryName(geometry)));
    }
  }

  const std::filesystem::path& file_;
  OGRLayerH layer_;
  std::vector<GeoFeature>& features_;
  Transformation to_wgs84_;
  int index_ = 0;
  std::int64_t next_index_ = 0;
};

std::vector<GeoFeature> read_by_gdal(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw ConfigError(
        fmt::format("file '{}' does not exist{}", file.string(), nearest_file_hint(file)));
  }
  const QuietGdal quiet;
  gdal().GDALAllRegister();
  const char* const drivers[] = {"LIBKML", "KML", "ESRI Shapefile", "GPKG", nullptr};
  const Dataset dataset(gdal().GDALOpenEx(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, drivers,
                                          nullptr, nullptr));
  if (!dataset) {
    throw ConfigError(fmt::format("file '{}' cannot be read: it is not a {}", file.string(),
                                  lower_extension(file) == ".shp"    ? "shapefile"
                                  : lower_extension(file) == ".gpkg" ? "GeoPackage"
                                                                     : "KML file"));
  }
  std::vector<GeoFeature> features;
  for (int k = 0; k < gdal().GDALDatasetGetLayerCount(dataset.get()); ++k) {
    LayerReader(file, gdal().GDALDatasetGetLayer(dataset.get(), k), features).read();
  }
  return features;
}

}  // namespace

std::vector<GeoFeature> read_features(const std::filesystem::path& file) {
  return is_read_by_gdal(file) ? read_by_gdal(file) : read_geojson(file);
}

std::string name_of_feature_file(const std::filesystem::path& file) {
  return fmt::format("{} '{}'", is_read_by_gdal(file) ? "file" : "GeoJSON file", file.string());
}

}  // namespace vinerow::io
