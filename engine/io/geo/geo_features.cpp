#include "engine/io/geo/geo_features.h"

#include <fmt/format.h>
#include <ogr_geometry.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/io/files/yaml.h"
#include "engine/io/geo/crs_text.h"
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
  LayerReader(const std::filesystem::path& file, OGRLayer& layer, std::vector<GeoFeature>& features)
      : file_(file), layer_(layer), features_(features) {
    const OGRSpatialReference* own = layer.GetSpatialRef();
    if (own == nullptr || own->IsEmpty() || own->IsLocal()) return;
    OGRSpatialReference from = *own;
    from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const OGRSpatialReference wgs84 = make_wgs84();
    to_wgs84_.reset(OGRCreateCoordinateTransformation(&from, &wgs84));
  }

  void read() {
    layer_.ResetReading();
    while (OGRFeature* next = layer_.GetNextFeature()) {
      const OGRFeatureUniquePtr source(next);
      GeoFeature feature;
      feature.index = index_ = static_cast<int>(next_index_++);
      for (int i = 0; i < source->GetFieldCount(); ++i) {
        if (!source->IsFieldSetAndNotNull(i)) continue;
        feature.properties[in_lower_case(source->GetFieldDefnRef(i)->GetNameRef())] =
            source->GetFieldAsString(i);
      }
      if (const OGRGeometry* geometry = source->GetGeometryRef()) add(*geometry, feature, 0);
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
    const bool is_good = std::isfinite(x) && std::isfinite(y) &&
                         to_wgs84_->Transform(1, &longitude_deg, &latitude_deg) != 0;
    if (!is_good || !(std::abs(longitude_deg) <= 180.0) || !(std::abs(latitude_deg) <= 90.0)) {
      fail(fmt::format("the coordinate ({}, {}) is not a valid position", x, y));
    }
    return {rad_from_deg(latitude_deg), rad_from_deg(longitude_deg), std::isfinite(z) ? z : 0.0};
  }

  void add_points(const OGRSimpleCurve& line, GeometryKind kind, GeoFeature feature) {
    feature.kind = kind;
    feature.has_altitude = line.Is3D() != 0;
    for (int i = 0; i < line.getNumPoints(); ++i) {
      feature.points.push_back(convert(line.getX(i), line.getY(i), line.getZ(i)));
    }
    if (feature.points.size() < 2) {
      fail(fmt::format("a line needs at least 2 points, it has {}", feature.points.size()));
    }
    features_.push_back(std::move(feature));
  }

  void add(const OGRGeometry& geometry, const GeoFeature& feature, int depth) {
    constexpr int kDeepest = 32;
    if (depth > kDeepest) fail("its geometry is nested too deeply");
    if (geometry.IsEmpty()) return;
    switch (wkbFlatten(geometry.getGeometryType())) {
      case wkbPoint: {
        const OGRPoint& point = *geometry.toPoint();
        GeoFeature one = feature;
        one.kind = GeometryKind::kPoint;
        one.has_altitude = point.Is3D() != 0;
        one.points = {convert(point.getX(), point.getY(), point.getZ())};
        features_.push_back(std::move(one));
        return;
      }
      case wkbLineString:
        add_points(*geometry.toLineString(), GeometryKind::kLineString, feature);
        return;
      case wkbPolygon: {
        const OGRLinearRing* ring = geometry.toPolygon()->getExteriorRing();
        if (ring == nullptr) fail("a polygon needs an outer ring");
        add_points(*ring, GeometryKind::kPolygon, feature);
        return;
      }
      case wkbMultiPoint:
      case wkbMultiLineString:
      case wkbMultiPolygon:
      case wkbGeometryCollection:
        for (const OGRGeometry* part : *geometry.toGeometryCollection()) {
          add(*part, feature, depth + 1);
        }
        return;
      default:
        fail(fmt::format("unknown geometry '{}'", geometry.getGeometryName()));
    }
  }

  const std::filesystem::path& file_;
  OGRLayer& layer_;
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
  GDALAllRegister();
  const char* const drivers[] = {"LIBKML", "KML", "ESRI Shapefile", "GPKG", nullptr};
  const Dataset dataset(static_cast<GDALDataset*>(
      GDALOpenEx(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, drivers, nullptr, nullptr)));
  if (!dataset) {
    throw ConfigError(fmt::format("file '{}' cannot be read: it is not a {}", file.string(),
                                  lower_extension(file) == ".shp"    ? "shapefile"
                                  : lower_extension(file) == ".gpkg" ? "GeoPackage"
                                                                     : "KML file"));
  }
  std::vector<GeoFeature> features;
  for (OGRLayer* layer : dataset->GetLayers()) LayerReader(file, *layer, features).read();
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
