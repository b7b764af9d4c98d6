#include "engine/io/geo/height_raster.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <memory>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/io/geo/gdal_handles.h"
#include "engine/io/geo/quiet_gdal.h"
#include "engine/math/angles.h"

namespace vinerow::io {
namespace {

struct Options {
  char** list = nullptr;
  ~Options() { CSLDestroy(list); }
};

/// CRS whose easting and northing are W's x and y.
OGRSpatialReference crs_about(const GeoOrigin& origin) {
  // The scale grows with the altitude, relative to the ellipsoid's mean radius of curvature at this
  // latitude.
  constexpr double kSemiMajor_m = 6378137.0, kFlattening = 1.0 / 298.257223563;  // WGS84
  constexpr double kEccentricity2 = kFlattening * (2.0 - kFlattening);
  const double sine = std::sin(origin.latitude_rad);
  const double radius_m =
      kSemiMajor_m * std::sqrt(1.0 - kEccentricity2) / (1.0 - kEccentricity2 * sine * sine);
  OGRSpatialReference crs;
  crs.SetProjCS(fmt::format("Local frame at {:.7f} N, {:.7f} E", deg_from_rad(origin.latitude_rad),
                            deg_from_rad(origin.longitude_rad))
                    .c_str());
  crs.SetWellKnownGeogCS("WGS84");
  crs.SetTM(deg_from_rad(origin.latitude_rad), deg_from_rad(origin.longitude_rad),
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
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  Options options;
  options.list = CSLSetNameValue(options.list, "COMPRESS", "DEFLATE");
  options.list = CSLSetNameValue(options.list, "PREDICTOR", "3");
  // Metadata is stored in the file itself, not in a separate .aux.xml file.
  options.list = CSLSetNameValue(options.list, "PROFILE", "GDALGeoTIFF");
  // Written atomically via a temporary file, since GDAL writes the file itself.
  const std::filesystem::path unfinished = temporary_name(file);
  Dataset dataset(driver == nullptr ? nullptr
                                    : driver->Create(unfinished.c_str(), field.columns, field.rows,
                                                     1, GDT_Float32, options.list));
  if (!dataset) fail(file, "cannot be written");
  const double half_m = 0.5 * field.cell_m;
  double transform[6] = {field.corner_W.x() - half_m,
                         field.cell_m,
                         0.0,
                         field.corner_W.y() + field.depth_m() + half_m,
                         0.0,
                         -field.cell_m};
  dataset->SetGeoTransform(transform);
  GDALRasterBand* band = dataset->GetRasterBand(1);
  if (origin) {
    const OGRSpatialReference crs = crs_about(*origin);
    dataset->SetSpatialRef(&crs);
    band->SetOffset(origin->altitude_m);
    band->SetScale(1.0);
  }
  band->SetUnitType("m");
  band->SetDescription("height of the ground");
  std::vector<float> row(static_cast<std::size_t>(field.columns));
  for (int j = 0; j < field.rows; ++j) {
    const auto* from =
        field.heights_m.data() + static_cast<std::size_t>(field.rows - 1 - j) * field.columns;
    std::copy(from, from + field.columns, row.begin());
    if (band->RasterIO(GF_Write, 0, j, field.columns, 1, row.data(), field.columns, 1, GDT_Float32,
                       0, 0) != CE_None) {
      dataset.reset();
      fail_to_store(file, unfinished);
    }
  }
  CPLErrorReset();
  errno = 0;
  dataset.reset();  // flushes the file
  if (CPLGetLastErrorType() >= CE_Failure) fail_to_store(file, unfinished);
  std::error_code failed;
  std::filesystem::rename(unfinished, file, failed);
  if (failed) throw_cannot_write(fmt::format("raster '{}'", file.string()), failed.value());
}

HeightField read_height_raster(const std::filesystem::path& file) {
  const QuietGdal quiet;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) fail(file, "does not exist");
  GDALAllRegister();
  const Dataset dataset(static_cast<GDALDataset*>(
      GDALOpenEx(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, nullptr, nullptr)));
  if (!dataset || dataset->GetRasterCount() < 1) {
    fail(file, "cannot be read: GDAL knows no such format, or it is cut off");
  }
  HeightField field;
  field.columns = dataset->GetRasterXSize();
  field.rows = dataset->GetRasterYSize();
  if (field.columns < 2 || field.rows < 2) {
    fail(file, fmt::format("has {} x {} pixels, needs at least 2 x 2", field.columns, field.rows));
  }
  double g[6];
  if (dataset->GetGeoTransform(g) != CE_None) fail(file, "has no georeference");
  if (g[2] != 0.0 || g[4] != 0.0 || !(g[1] > 0.0) || !(std::abs(g[1] + g[5]) < 1e-9 * g[1])) {
    fail(file, "must have square pixels with north up");
  }
  field.cell_m = g[1];
  field.corner_W = {g[0] + 0.5 * g[1], g[3] + (field.rows - 0.5) * g[5]};
  field.heights_m.resize(static_cast<std::size_t>(field.columns) * field.rows);
  GDALRasterBand* band = dataset->GetRasterBand(1);
  for (int j = 0; j < field.rows; ++j) {
    float* to =
        field.heights_m.data() + static_cast<std::size_t>(field.rows - 1 - j) * field.columns;
    if (band->RasterIO(GF_Read, 0, j, field.columns, 1, to, field.columns, 1, GDT_Float32, 0, 0) !=
        CE_None) {
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
