#pragma once
/// Height fields of W as GeoTIFF, for QGIS and other programs of surveyors.

#include <filesystem>
#include <optional>

#include "engine/api/height_field.h"
#include "engine/math/geo_origin.h"

namespace vinerow::io {

/// Writes one band of float32, a pixel around every sample, the northern row first, deflated.
///
/// With an origin the CRS is a transverse Mercator projection of WGS84 about it, with the scale of
/// its altitude: W's x and y are its easting and northing to 0.1 mm within 1 km where the origin is
/// at 300 m (the ellipsoid's two curvatures differ, so that one scale does not fit both; in
/// proportion for other altitudes). The band's offset is the origin's altitude, so
/// that readers show heights above the ellipsoid; they are of W's level plane, which leaves the
/// ellipsoid by d^2 / 2R: 0.8 mm at 100 m, 78 mm at 1 km. Without an origin the raster has no CRS,
/// and no offset.
/// @throws ConfigError naming the file where it cannot be written, or a height is not finite
void write_height_raster(const HeightField& field, const std::optional<GeoOrigin>& origin,
                         const std::filesystem::path& file);

/// What write_height_raster() wrote, in W: heights bit for bit, corner and cell to the rounding of
/// the file's georeference. @throws ConfigError naming the file: missing, no raster, pixels broken
/// or cut off, turned or with pixels that are not square, less than 2 x 2 of them, not finite
HeightField read_height_raster(const std::filesystem::path& file);

}  // namespace vinerow::io
