#include "engine/io/geo/gis_files.h"

#include <fmt/format.h>

#include <memory>

#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/io/geo/crs.h"
#include "engine/io/geo/gdal_handles.h"
#include "engine/io/geo/quiet_gdal.h"

namespace vinerow::io {
namespace {

[[noreturn]] void fail_gis(const std::filesystem::path& file, const std::string& sentence) {
  throw ConfigError(fmt::format("'{}' {}", file.string(), sentence));
}

/// Parses a CRS; empty if `text` is empty.
Crs reference_of(const std::string& text) {
  return text.empty() ? Crs() : parse_crs(text);
}

/// Scope with a fixed date: GeoPackages contain their creation time, but equal layers must give
/// equal bytes.
class FixedDate {
 public:
  FixedDate() { set("2000-01-01T00:00:00.000Z"); }
  ~FixedDate() { set(nullptr); }
  FixedDate(const FixedDate&) = delete;
  FixedDate& operator=(const FixedDate&) = delete;

 private:
  static void set(const char* date) {
    gdal().CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", date);
  }
};

OGRFieldType field_type(const GisValue& value) {
  if (std::holds_alternative<std::int64_t>(value)) return OFTInteger64;
  return std::holds_alternative<double>(value) ? OFTReal : OFTString;
}

/// A line or ring with these points.
OGRGeometryH make_line(OGRwkbGeometryType type, const std::vector<Eigen::Vector3d>& points) {
  const OGRGeometryH line = gdal().OGR_G_CreateGeometry(type);
  for (const Eigen::Vector3d& p : points) gdal().OGR_G_AddPoint(line, p.x(), p.y(), p.z());
  return line;
}

/// The caller owns the geometry.
OGRGeometryH geometry_of(GeometryKind kind, const std::vector<Eigen::Vector3d>& points) {
  if (kind == GeometryKind::kPoint) return make_line(wkbPoint, {points.front()});
  if (kind == GeometryKind::kLineString) return make_line(wkbLineString, points);
  const OGRGeometryH polygon = gdal().OGR_G_CreateGeometry(wkbPolygon);
  gdal().OGR_G_AddGeometryDirectly(polygon, make_line(wkbLinearRing, points));
  gdal().OGR_G_CloseRings(polygon);
  return polygon;
}

struct FieldDestroyer {
  void operator()(OGRFieldDefnH field) const { gdal().OGR_Fld_Destroy(field); }
};

void set_field(OGRFeatureH feature, int at, const GisValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) {
    gdal().OGR_F_SetFieldInteger64(feature, at, static_cast<GIntBig>(*whole));
  } else if (const auto* number = std::get_if<double>(&value)) {
    gdal().OGR_F_SetFieldDouble(feature, at, *number);
  } else {
    gdal().OGR_F_SetFieldString(feature, at, std::get<std::string>(value).c_str());
  }
}

void add_features(const GisLayer& from, const std::filesystem::path& file, OGRLayerH layer) {
  for (std::size_t k = 0; k < from.fields.size(); ++k) {
    const std::unique_ptr<void, FieldDestroyer> field(
        gdal().OGR_Fld_Create(from.fields[k].c_str(), field_type(from.features.front().values[k])));
    constexpr int kMayBeRounded = 1;
    if (gdal().OGR_L_CreateField(layer, field.get(), kMayBeRounded) != OGRERR_NONE) {
      fail_gis(file, "cannot be written");
    }
  }
  for (const GisFeature& given : from.features) {
    const FeatureHandle feature(gdal().OGR_F_Create(gdal().OGR_L_GetLayerDefn(layer)));
    for (std::size_t k = 0; k < from.fields.size(); ++k) {
      set_field(feature.get(), static_cast<int>(k), given.values[k]);
    }
    gdal().OGR_F_SetGeometryDirectly(feature.get(), geometry_of(from.kind, given.points));
    if (gdal().OGR_L_CreateFeature(layer, feature.get()) != OGRERR_NONE) {
      fail_gis(file, "cannot be written completely");
    }
  }
}

}  // namespace

void write_crs_raster(const CrsRaster& raster, const std::filesystem::path& file) {
  VINEROW_DEMAND(raster.values.size() == static_cast<std::size_t>(raster.columns) * raster.rows);
  const QuietGdal quiet;
  gdal().GDALAllRegister();
  const Crs crs = reference_of(raster.crs);
  const GDALDriverH driver = gdal().GDALGetDriverByName("GTiff");
  const DriverOptions options = {"COMPRESS=DEFLATE", "PREDICTOR=3", "PROFILE=GDALGeoTIFF"};
  Dataset dataset(driver == nullptr
                      ? nullptr
                      : gdal().GDALCreate(driver, file.c_str(), raster.columns, raster.rows, 1,
                                          GDT_Float32, options.list()));
  if (!dataset) fail_gis(file, "cannot be written");
  double transform[6] = {raster.north_west.x(), raster.cell, 0.0,
                         raster.north_west.y(), 0.0,         -raster.cell};
  gdal().GDALSetGeoTransform(dataset.get(), transform);
  if (!raster.crs.empty()) gdal().GDALSetSpatialRef(dataset.get(), crs.get());
  const GDALRasterBandH band = gdal().GDALGetRasterBand(dataset.get(), 1);
  gdal().GDALSetRasterNoDataValue(band, CrsRaster::kNoHeight);
  gdal().GDALSetRasterUnitType(band, "m");
  gdal().GDALSetDescription(band, raster.description.c_str());
  // GDAL does not modify the values.
  auto* values = const_cast<float*>(raster.values.data());
  if (gdal().GDALRasterIO(band, GF_Write, 0, 0, raster.columns, raster.rows, values, raster.columns,
                          raster.rows, GDT_Float32, 0, 0) != CE_None) {
    fail_gis(file, "cannot be written completely");
  }
  gdal().CPLErrorReset();
  dataset.reset();  // flushes the file
  if (gdal().CPLGetLastErrorType() >= CE_Failure) fail_gis(file, "cannot be written completely");
}

void write_geopackage(const std::vector<GisLayer>& layers, const std::string& crs_text,
                      const std::filesystem::path& file) {
  const QuietGdal quiet;
  const FixedDate date;
  gdal().GDALAllRegister();
  const Crs crs = reference_of(crs_text);
  std::error_code error;
  std::filesystem::remove(file, error);
  const GDALDriverH driver = gdal().GDALGetDriverByName("GPKG");
  Dataset dataset(driver == nullptr
                      ? nullptr
                      : gdal().GDALCreate(driver, file.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!dataset) fail_gis(file, "cannot be written");
  for (const GisLayer& layer : layers) {
    VINEROW_DEMAND(!layer.features.empty());
    const OGRwkbGeometryType type = layer.kind == GeometryKind::kPoint        ? wkbPoint25D
                                    : layer.kind == GeometryKind::kLineString ? wkbLineString25D
                                                                              : wkbPolygon25D;
    const OGRLayerH created = gdal().GDALDatasetCreateLayer(
        dataset.get(), layer.name.c_str(), crs_text.empty() ? nullptr : crs.get(), type, nullptr);
    if (created == nullptr) fail_gis(file, "cannot be written");
    add_features(layer, file, created);
  }
  gdal().CPLErrorReset();
  dataset.reset();
  if (gdal().CPLGetLastErrorType() >= CE_Failure) fail_gis(file, "cannot be written completely");
}

}  // namespace vinerow::io
