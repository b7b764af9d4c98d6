#include "engine/io/geo/gis_files.h"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <memory>

#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/io/geo/gdal_handles.h"
#include "engine/io/geo/quiet_gdal.h"

namespace vinerow::io {
namespace {

[[noreturn]] void fail_gis(const std::filesystem::path& file, const std::string& sentence) {
  throw ConfigError(fmt::format("'{}' {}", file.string(), sentence));
}

/// Parses a CRS; empty if `text` is empty.
OGRSpatialReference reference_of(const std::string& text) {
  OGRSpatialReference crs;
  if (!text.empty() && crs.SetFromUserInput(text.c_str()) != OGRERR_NONE) {
    throw ConfigError(
        fmt::format("crs = '{}' is not a coordinate reference system, must be like EPSG:32632",
                    text.substr(0, 60)));
  }
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

/// Scope with a fixed date: GeoPackages contain their creation time, but equal layers must give
/// equal bytes.
class FixedDate {
 public:
  FixedDate() { CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", "2000-01-01T00:00:00.000Z"); }
  ~FixedDate() { CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", nullptr); }
  FixedDate(const FixedDate&) = delete;
  FixedDate& operator=(const FixedDate&) = delete;
};

OGRFieldType field_type(const GisValue& value) {
  if (std::holds_alternative<std::int64_t>(value)) return OFTInteger64;
  return std::holds_alternative<double>(value) ? OFTReal : OFTString;
}

std::unique_ptr<OGRGeometry> geometry_of(GeometryKind kind,
                                         const std::vector<Eigen::Vector3d>& points) {
  if (kind == GeometryKind::kPoint) {
    const Eigen::Vector3d& p = points.front();
    return std::make_unique<OGRPoint>(p.x(), p.y(), p.z());
  }
  const auto fill = [&](OGRSimpleCurve& line) {
    for (const Eigen::Vector3d& p : points) line.addPoint(p.x(), p.y(), p.z());
  };
  if (kind == GeometryKind::kLineString) {
    auto line = std::make_unique<OGRLineString>();
    fill(*line);
    return line;
  }
  auto ring = std::make_unique<OGRLinearRing>();
  fill(*ring);
  ring->closeRings();
  auto polygon = std::make_unique<OGRPolygon>();
  polygon->addRingDirectly(ring.release());
  return polygon;
}

void add_features(const GisLayer& from, const std::filesystem::path& file, OGRLayer& layer) {
  for (std::size_t k = 0; k < from.fields.size(); ++k) {
    OGRFieldDefn field(from.fields[k].c_str(), field_type(from.features.front().values[k]));
    if (layer.CreateField(&field) != OGRERR_NONE) fail_gis(file, "cannot be written");
  }
  for (const GisFeature& given : from.features) {
    OGRFeature feature(layer.GetLayerDefn());
    for (std::size_t k = 0; k < from.fields.size(); ++k) {
      const int at = static_cast<int>(k);
      const GisValue& value = given.values[k];
      if (const auto* whole = std::get_if<std::int64_t>(&value)) {
        feature.SetField(at, static_cast<GIntBig>(*whole));
      } else if (const auto* number = std::get_if<double>(&value)) {
        feature.SetField(at, *number);
      } else {
        feature.SetField(at, std::get<std::string>(value).c_str());
      }
    }
    feature.SetGeometryDirectly(geometry_of(from.kind, given.points).release());
    if (layer.CreateFeature(&feature) != OGRERR_NONE) {
      fail_gis(file, "cannot be written completely");
    }
  }
}

}  // namespace

void write_crs_raster(const CrsRaster& raster, const std::filesystem::path& file) {
  VINEROW_DEMAND(raster.values.size() == static_cast<std::size_t>(raster.columns) * raster.rows);
  const QuietGdal quiet;
  GDALAllRegister();
  const OGRSpatialReference crs = reference_of(raster.crs);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  char** options = nullptr;
  for (const char* option : {"COMPRESS=DEFLATE", "PREDICTOR=3", "PROFILE=GDALGeoTIFF"}) {
    options = CSLAddString(options, option);
  }
  Dataset dataset(driver == nullptr ? nullptr
                                    : driver->Create(file.c_str(), raster.columns, raster.rows, 1,
                                                     GDT_Float32, options));
  CSLDestroy(options);
  if (!dataset) fail_gis(file, "cannot be written");
  double transform[6] = {raster.north_west.x(), raster.cell, 0.0,
                         raster.north_west.y(), 0.0,         -raster.cell};
  dataset->SetGeoTransform(transform);
  if (!raster.crs.empty()) dataset->SetSpatialRef(&crs);
  GDALRasterBand* band = dataset->GetRasterBand(1);
  band->SetNoDataValue(CrsRaster::kNoHeight);
  band->SetUnitType("m");
  band->SetDescription(raster.description.c_str());
  // GDAL does not modify the values.
  auto* values = const_cast<float*>(raster.values.data());
  if (band->RasterIO(GF_Write, 0, 0, raster.columns, raster.rows, values, raster.columns,
                     raster.rows, GDT_Float32, 0, 0) != CE_None) {
    fail_gis(file, "cannot be written completely");
  }
  CPLErrorReset();
  dataset.reset();  // flushes the file
  if (CPLGetLastErrorType() >= CE_Failure) fail_gis(file, "cannot be written completely");
}

void write_geopackage(const std::vector<GisLayer>& layers, const std::string& crs_text,
                      const std::filesystem::path& file) {
  const QuietGdal quiet;
  const FixedDate date;
  GDALAllRegister();
  OGRSpatialReference crs = reference_of(crs_text);
  std::error_code error;
  std::filesystem::remove(file, error);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  Dataset dataset(driver == nullptr ? nullptr
                                    : driver->Create(file.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!dataset) fail_gis(file, "cannot be written");
  for (const GisLayer& layer : layers) {
    VINEROW_DEMAND(!layer.features.empty());
    const OGRwkbGeometryType type = layer.kind == GeometryKind::kPoint        ? wkbPoint25D
                                    : layer.kind == GeometryKind::kLineString ? wkbLineString25D
                                                                              : wkbPolygon25D;
    OGRLayer* created =
        dataset->CreateLayer(layer.name.c_str(), crs_text.empty() ? nullptr : &crs, type, nullptr);
    if (created == nullptr) fail_gis(file, "cannot be written");
    add_features(layer, file, *created);
  }
  CPLErrorReset();
  dataset.reset();
  if (CPLGetLastErrorType() >= CE_Failure) fail_gis(file, "cannot be written completely");
}

}  // namespace vinerow::io
