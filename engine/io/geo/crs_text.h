#pragma once
/// Coordinate reference systems as people write them.

#include <ogr_spatialref.h>

#include <string>

namespace vinerow::io {

/// @param text  "EPSG:25832", the code alone, WKT, or what else PROJ reads; no file and no address
/// @throws ConfigError "crs = 'x' is not a coordinate reference system, must be like EPSG:32632"
OGRSpatialReference parse_crs(const std::string& text);

/// Longitude and latitude in degrees, in this order.
OGRSpatialReference make_wgs84();

}  // namespace vinerow::io
