#include "engine/io/geo/raster.h"

#include <fmt/format.h>
#include <strings.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "engine/core/error.h"
#include "engine/io/geo/crs.h"
#include "engine/io/geo/gdal_handles.h"
#include "engine/io/geo/quiet_gdal.h"
#include "engine/math/angles.h"
#include "engine/math/geo.h"

namespace vinerow::io {
/// Transformation from WGS84 (longitude, latitude in degrees) to the raster's CRS.
class ToRaster {
 public:
  explicit ToRaster(const ElevationRaster& raster) : raster_(raster) {
    transformation_ = Transformation(make_wgs84(), parse_wkt(raster.crs_wkt));
    if (!transformation_) {
      throw ConfigError(fmt::format("raster '{}': no transformation from WGS84 to '{}'",
                                    raster.file.string(), raster.crs_name));
    }
    const double* g = raster.geo_transform;
    const double determinant = g[1] * g[5] - g[2] * g[4];
    inverse_ = {g[5] / determinant, -g[2] / determinant, -g[4] / determinant, g[1] / determinant};
  }

  /// Column and row of a position, whole at pixel centres; nullopt outside the raster.
  std::optional<Eigen::Vector2d> pixel(double latitude_rad, double longitude_rad) const {
    double x = deg_from_rad(longitude_rad), y = deg_from_rad(latitude_rad);
    if (!transformation_.apply(x, y)) return std::nullopt;
    const double dx = x - raster_.geo_transform[0], dy = y - raster_.geo_transform[3];
    const double column = inverse_[0] * dx + inverse_[1] * dy - 0.5;
    const double row = inverse_[2] * dx + inverse_[3] * dy - 0.5;
    if (!(column >= -0.5 && row >= -0.5 && column <= raster_.columns - 0.5 &&
          row <= raster_.rows - 0.5)) {
      return std::nullopt;
    }
    return Eigen::Vector2d(column, row);
  }

  /// Bilinear between pixel centres. @returns NaN outside or at "no data"
  double height_m(double latitude_rad, double longitude_rad) const {
    const auto place = pixel(latitude_rad, longitude_rad);
    if (!place) return std::numeric_limits<double>::quiet_NaN();
    // The outer half of a border pixel has no neighbour: its height is extrapolated as constant.
    const double c = std::clamp(place->x(), 0.0, raster_.columns - 1.0);
    const double r = std::clamp(place->y(), 0.0, raster_.rows - 1.0);
    const int i = std::min(static_cast<int>(c), std::max(raster_.columns - 2, 0));
    const int j = std::min(static_cast<int>(r), std::max(raster_.rows - 2, 0));
    const int i1 = std::min(i + 1, raster_.columns - 1), j1 = std::min(j + 1, raster_.rows - 1);
    const double u = c - i, v = r - j;
    const auto at = [&](int ci, int rj) -> double {
      return raster_.heights_m[static_cast<std::size_t>(rj) * raster_.columns + ci];
    };
    return (1 - v) * ((1 - u) * at(i, j) + u * at(i1, j)) +
           v * ((1 - u) * at(i, j1) + u * at(i1, j1));
  }

 private:
  const ElevationRaster& raster_;
  Transformation transformation_;
  std::array<double, 4> inverse_{};
};

namespace {

/// "; its middle is at latitude 45.0 deg, longitude 9.0 deg", or "" if WGS84 does not reach it.
std::string name_middle(const ElevationRaster& raster) {
  const double* g = raster.geo_transform;
  double x = g[0] + 0.5 * (raster.columns * g[1] + raster.rows * g[2]);
  double y = g[3] + 0.5 * (raster.columns * g[4] + raster.rows * g[5]);
  const Transformation to_wgs84(parse_wkt(raster.crs_wkt), make_wgs84());
  if (!to_wgs84 || !to_wgs84.apply(x, y)) return "";
  return fmt::format("; its middle is at latitude {:.6f} deg, longitude {:.6f} deg", y, x);
}

[[noreturn]] void fail_without_height(const ElevationRaster& raster, const ToRaster& to_raster,
                                      double latitude_rad, double longitude_rad) {
  if (to_raster.pixel(latitude_rad, longitude_rad)) {
    throw ConfigError(fmt::format(
        "raster '{}' has a hole (\"no data\") at latitude {:.6f} deg, longitude {:.6f} deg, where "
        "the world has ground: fill it, as with gdal_fillnodata.py, or move the world",
        raster.file.string(), deg_from_rad(latitude_rad), deg_from_rad(longitude_rad)));
  }
  const double* g = raster.geo_transform;
  const bool is_swapped = std::abs(longitude_rad) <= 0.5 * kPi &&
                          std::isfinite(to_raster.height_m(longitude_rad, latitude_rad));
  throw ConfigError(
      fmt::format("raster '{}' has no height at latitude {:.6f} deg, longitude {:.6f} deg; it "
                  "covers x {:.9g} to {:.9g}, y {:.9g} to {:.9g} of {}{}",
                  raster.file.string(), deg_from_rad(latitude_rad), deg_from_rad(longitude_rad),
                  g[0], g[0] + raster.columns * g[1] + raster.rows * g[2],
                  g[3] + raster.columns * g[4] + raster.rows * g[5], g[3], raster.crs_name,
                  is_swapped ? "; are latitude and longitude swapped?" : name_middle(raster)));
}

/// Metres in a unit of heights by GDAL's names for those of GeoTIFF and other files. A name that is
/// not known, and none, is the metre.
double height_unit_m(const char* name) {
  for (const char* foot : {"ft", "foot", "feet", "international foot"}) {
    if (strcasecmp(name, foot) == 0) return 0.3048;
  }
  for (const char* foot : {"us survey foot", "us-ft", "ftus", "us_ft", "foot_us"}) {
    if (strcasecmp(name, foot) == 0) return 1200.0 / 3937.0;
  }
  return 1.0;
}

void read_crs(ElevationRaster& raster, GDALDatasetH dataset, const std::string& wanted) {
  std::optional<Crs> crs;
  if (!wanted.empty()) {
    crs = parse_crs(wanted);
  } else {
    const OGRSpatialReferenceH own = gdal().GDALGetSpatialRef(dataset);
    if (!is_georeferenced(own)) {
      throw ConfigError(fmt::format(
          "raster '{}' has no coordinate reference system; give it by 'crs: EPSG:<code>'",
          raster.file.string()));
    }
    crs = Crs(own);
  }
  raster.crs_wkt = wkt_of(*crs);
  raster.crs_name = crs->name();
}

}  // namespace

ElevationRaster read_elevation(const std::filesystem::path& file, const std::string& crs) {
  const QuietGdal quiet;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw ConfigError(fmt::format("raster '{}' does not exist", file.string()));
  }
  gdal().GDALAllRegister();
  const Dataset dataset(gdal().GDALOpenEx(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr,
                                          nullptr, nullptr));
  if (!dataset || gdal().GDALGetRasterCount(dataset.get()) < 1) {
    throw ConfigError(
        fmt::format("raster '{}' cannot be read: GDAL knows no such format", file.string()));
  }
  ElevationRaster raster;
  raster.file = file;
  raster.columns = gdal().GDALGetRasterXSize(dataset.get());
  raster.rows = gdal().GDALGetRasterYSize(dataset.get());
  read_crs(raster, dataset.get(), crs);
  const double* g = raster.geo_transform;
  if (gdal().GDALGetGeoTransform(dataset.get(), raster.geo_transform) != CE_None ||
      g[1] * g[5] - g[2] * g[4] == 0.0) {
    throw ConfigError(
        fmt::format("raster '{}' has no georeference (no geotransform)", file.string()));
  }

  constexpr double kMaxPixels = 250e6;  // a gigabyte
  if (static_cast<double>(raster.columns) * raster.rows > kMaxPixels) {
    throw ConfigError(fmt::format(
        "raster '{}' has {} x {} pixels, must have at most {:g} million: cut out the needed area "
        "with 'gdal_translate -projwin'",
        file.string(), raster.columns, raster.rows, kMaxPixels / 1e6));
  }
  const GDALRasterBandH band = gdal().GDALGetRasterBand(dataset.get(), 1);
  raster.heights_m.resize(static_cast<std::size_t>(raster.columns) * raster.rows);
  if (gdal().GDALRasterIO(band, GF_Read, 0, 0, raster.columns, raster.rows, raster.heights_m.data(),
                          raster.columns, raster.rows, GDT_Float32, 0, 0) != CE_None) {
    throw ConfigError(
        fmt::format("raster '{}' cannot be read: its pixels are broken", file.string()));
  }
  int has_no_data = 0;
  const auto no_data = static_cast<float>(gdal().GDALGetRasterNoDataValue(band, &has_no_data));
  int has_scale = 0, has_offset = 0;
  const double scale = gdal().GDALGetRasterScale(band, &has_scale),
               offset = gdal().GDALGetRasterOffset(band, &has_offset);
  const double unit_m = height_unit_m(gdal().GDALGetRasterUnitType(band));
  for (float& height : raster.heights_m) {
    if ((has_no_data && height == no_data) || !std::isfinite(height)) {
      height = std::numeric_limits<float>::quiet_NaN();
    } else if (has_scale || has_offset || unit_m != 1.0) {
      height = static_cast<float>(
          unit_m * ((has_scale ? scale : 1.0) * height + (has_offset ? offset : 0.0)));
    }
  }
  return raster;
}

struct ElevationLookup::Impl {
  explicit Impl(ElevationRaster given) : raster(std::move(given)), to_raster(raster) {}
  const ElevationRaster raster;
  const ToRaster to_raster;
};

ElevationLookup::ElevationLookup(ElevationRaster raster) {
  const QuietGdal quiet;
  impl_ = std::make_unique<Impl>(std::move(raster));
}

ElevationLookup::~ElevationLookup() = default;

std::optional<double> ElevationLookup::height_m(double latitude_rad, double longitude_rad) const {
  const QuietGdal quiet;
  const double height = impl_->to_raster.height_m(latitude_rad, longitude_rad);
  return std::isfinite(height) ? std::optional(height) : std::nullopt;
}

HeightField resample_elevation(const ElevationRaster& raster, const GeoOrigin& origin,
                               const FieldExtent& extent) {
  const QuietGdal quiet;
  const ToRaster to_raster(raster);
  const LocalFrame frame(origin);
  HeightField field;
  field.cell_m = extent.cell_m;
  field.corner_W = extent.corner_W;
  field.columns = std::max(2, static_cast<int>(std::ceil(extent.width_m / extent.cell_m)) + 1);
  field.rows = std::max(2, static_cast<int>(std::ceil(extent.depth_m / extent.cell_m)) + 1);
  field.heights_m.reserve(static_cast<std::size_t>(field.columns) * field.rows);
  for (int j = 0; j < field.rows; ++j) {
    for (int i = 0; i < field.columns; ++i) {
      const Eigen::Vector3d p_W(field.corner_W.x() + i * field.cell_m,
                                field.corner_W.y() + j * field.cell_m, 0.0);
      // altitude_m of this point is the altitude of W's tangent plane.
      const Geodetic point = frame.to_geodetic(p_W);
      const double height = to_raster.height_m(point.latitude_rad, point.longitude_rad);
      if (!std::isfinite(height)) {
        fail_without_height(raster, to_raster, point.latitude_rad, point.longitude_rad);
      }
      // The lowest ground on land is 430 m below the sea, the highest 8849 m above it.
      constexpr double kLowest_m = -500.0, kHighest_m = 9000.0;
      if (height < kLowest_m || height > kHighest_m) {
        throw ConfigError(fmt::format(
            "raster '{}' has a height of {:g} m at latitude {:.6f} deg, longitude {:.6f} deg: is "
            "this an undeclared \"no data\" value?",
            raster.file.string(), height, deg_from_rad(point.latitude_rad),
            deg_from_rad(point.longitude_rad)));
      }
      field.heights_m.push_back(static_cast<float>(height - point.altitude_m));
    }
  }
  return field;
}

}  // namespace vinerow::io
