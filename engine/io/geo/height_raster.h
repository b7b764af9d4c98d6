#pragma once
/// GeoTIFF reader and writer for height fields in W, for QGIS and other GIS programs.

#include <filesystem>
#include <optional>

#include "engine/api/height_field.h"
#include "engine/math/geo_origin.h"

namespace vinerow::io {

/// Writes one band of float32, one pixel centred on each sample, northern row first, deflated.
///
/// With an origin, the CRS is a transverse Mercator projection of WGS84 about it, scaled for its
/// altitude. Easting and northing equal W's x and y to 0.1 mm within 1 km if the origin is at 300
/// m; the error is proportional to the altitude, because one scale cannot fit both curvatures of
/// the ellipsoid. The band's offset is the origin's altitude, so that readers show heights above
/// the ellipsoid. Heights refer to W's level plane, which departs from the ellipsoid by d^2 / 2R:
/// 0.8 mm at 100 m, 78 mm at 1 km. Without an origin, the raster has neither CRS nor offset.
/// @throws ConfigError naming the file if it cannot be written or a height is not finite
void write_height_raster(const HeightField& field, const std::optional<GeoOrigin>& origin,
                         const std::filesystem::path& file);

/// Reads a file of write_height_raster() as a height field in W. Heights are equal bit for bit,
/// corner and cell up to the rounding of the file's georeference. @throws ConfigError naming the
/// file: missing, not a raster, damaged or truncated pixels, rotated or not square pixels, fewer
/// than 2 x 2 pixels, values that are not finite
HeightField read_height_raster(const std::filesystem::path& file);

}  // namespace vinerow::io
