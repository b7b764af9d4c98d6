#include "engine/io/geo/height_raster.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <memory>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/io/geo/crs.h"
#include "engine/io/geo/gdal_handles.h"
#include "engine/io/geo/quiet_gdal.h"
#include "engine/math/angles.h"

namespace vinerow::io {
namespace {

/// CRS whose easting and northing are W's x and y.
Crs crs_about(const GeoOrigin& origin) {
  // The scale grows with the altitude, relative to the ellipsoid's mean radius of curvature at this
  // latitude.
  constexpr double kSemiMajor_m = 6378137.0, kFlattening = 1.0 / 298.257223563;  // WGS84
  constexpr double kEccentricity2 = kFlattening * (2.0 - kFlattening);
  const double sine = std::sin(origin.latitude_rad);
  const double radius_m =
      kSemiMajor_m * std::sqrt(1.0 - kEccentricity2) / (1.0 - kEccentricity2 * sine * sine);
  const std::string name =
      fmt::format("Local frame at {:.7f} N, {:.7f} E", deg_from_rad(origin.latitude_rad),
                  deg_from_rad(origin.longitude_rad));
  Crs crs;
  gdal().OSRSetProjCS(crs.get(), name.c_str());
  gdal().OSRSetWellKnownGeogCS(crs.get(), "WGS84");
  gdal().OSRSetTM(crs.get(), deg_from_rad(origin.latitude_rad), deg_from_rad(origin.longitude_rad),
                  1.0 + origin.altitude_m / radius_m, 0.0, 0.0);
  return crs;
}

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& sentence) {
  throw ConfigError(fmt::format("raster '{}' {}", file.string(), sentence));
}

/// @pre errno is that of the failed call, if the library kept it
[[noreturn]] void fail_to_store(const std::filesystem::path& file,
                                const std::filesystem::path& unfinished) {
  const int error_number = errno != 0 ? errno : EIO;
  std::error_code ignored;
  std::filesystem::remove(unfinished, ignored);
  throw_cannot_write(fmt::format("raster '{}'", file.string()), error_number);
}

}  // namespace

void write_height_raster(const HeightField& field, const std::optional<GeoOrigin>& origin,
                         const std::filesystem::path& file) {
  const QuietGdal quiet;
  if (!std::all_of(field.heights_m.begin(), field.heights_m.end(),
                   [](float height_m) { return std::isfinite(height_m); })) {
    fail(file, "cannot be written: the terrain has a height that is not finite");
  }
  gdal().GDALAllRegister();
  const GDALDriverH driver = gdal().GDALGetDriverByName("GTiff");
  // The profile: metadata is stored in the file itself, not in a separate .aux.xml file.
  const DriverOptions options = {"COMPRESS=DEFLATE", "PREDICTOR=3", "PROFILE=GDALGeoTIFF"};
  // Written atomically via a temporary file, since GDAL writes the file itself.
  const std::filesystem::path unfinished = temporary_name(file);
  Dataset dataset(driver == nullptr
                      ? nullptr
                      : gdal().GDALCreate(driver, unfinished.c_str(), field.columns, field.rows, 1,
                                          GDT_Float32, options.list()));
  if (!dataset) fail(file, "cannot be written");
  const double half_m = 0.5 * field.cell_m;
  double transform[6] = {field.corner_W.x() - half_m,
                         field.cell_m,
                         0.0,
                         field.corner_W.y() + field.depth_m() + half_m,
                         0.0,
                         -field.cell_m};
  gdal().GDALSetGeoTransform(dataset.get(), transform);
  const GDALRasterBandH band = gdal().GDALGetRasterBand(dataset.get(), 1);
  if (origin) {
    const Crs crs = crs_about(*origin);
    gdal().GDALSetSpatialRef(dataset.get(), crs.get());
    gdal().GDALSetRasterOffset(band, origin->altitude_m);
    gdal().GDALSetRasterScale(band, 1.0);
  }
  gdal().GDALSetRasterUnitType(band, "m");
  gdal().GDALSetDescription(band, "height of the ground");
  std::vector<float> row(static_cast<std::size_t>(field.columns));
  for (int j = 0; j < field.rows; ++j) {
    const auto* from =
        field.heights_m.data() + static_cast<std::size_t>(field.rows - 1 - j) * field.columns;
    std::copy(from, from + field.columns, row.begin());
    if (gdal().GDALRasterIO(band, GF_Write, 0, j, field.columns, 1, row.data(), field.columns, 1,
                            GDT_Float32, 0, 0) != CE_None) {
      dataset.reset();
      fail_to_store(file, unfinished);
    }
  }
  gdal().CPLErrorReset();
  errno = 0;
  dataset.reset();  // flushes the file
  if (gdal().CPLGetLastErrorType() >= CE_Failure) fail_to_store(file, unfinished);
  std::error_code failed;
  std::filesystem::rename(unfinished, file, failed);
  if (failed) throw_cannot_write(fmt::format("raster '{}'", file.string()), failed.value());
}

HeightField read_height_raster(const std::filesystem::path& file) {
  const QuietGdal quiet;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) fail(file, "does not exist");
  gdal().GDALAllRegister();
  const Dataset dataset(gdal().GDALOpenEx(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr,
                                          nullptr, nullptr));
  if (!dataset || gdal().GDALGetRasterCount(dataset.get()) < 1) {
    fail(file, "cannot be read: GDAL knows no such format, or it is cut off");
  }
  HeightField field;
  field.columns = gdal().GDALGetRasterXSize(dataset.get());
  field.rows = gdal().GDALGetRasterYSize(dataset.get());
  if (field.columns < 2 || field.rows < 2) {
    fail(file, fmt::format("has {} x {} pixels, needs at least 2 x 2", field.columns, field.rows));
  }
  double g[6];
  if (gdal().GDALGetGeoTransform(dataset.get(), g) != CE_None) fail(file, "has no georeference");
  if (g[2] != 0.0 || g[4] != 0.0 || !(g[1] > 0.0) || !(std::abs(g[1] + g[5]) < 1e-9 * g[1])) {
    fail(file, "must have square pixels with north up");
  }
  field.cell_m = g[1];
  field.corner_W = {g[0] + 0.5 * g[1], g[3] + (field.rows - 0.5) * g[5]};
  field.heights_m.resize(static_cast<std::size_t>(field.columns) * field.rows);
  const GDALRasterBandH band = gdal().GDALGetRasterBand(dataset.get(), 1);
  for (int j = 0; j < field.rows; ++j) {
    float* to =
        field.heights_m.data() + static_cast<std::size_t>(field.rows - 1 - j) * field.columns;
    if (gdal().GDALRasterIO(band, GF_Read, 0, j, field.columns, 1, to, field.columns, 1,
                            GDT_Float32, 0, 0) != CE_None) {
      fail(file, "cannot be read: its pixels are broken or cut off");
    }
  }
  if (!std::all_of(field.heights_m.begin(), field.heights_m.end(),
                   [](float height_m) { return std::isfinite(height_m); })) {
    fail(file, "has a height that is not finite");
  }
  return field;
}

}  // namespace vinerow::io
