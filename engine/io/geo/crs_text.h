#pragma once
/// Parser of coordinate reference systems from user input.

#include <ogr_spatialref.h>

#include <string>

namespace vinerow::io {

/// @param text  "EPSG:25832", the code alone, WKT, or another form that PROJ reads, except files
/// and URLs
/// @throws ConfigError "crs = 'x' is not a coordinate reference system, must be like EPSG:32632"
OGRSpatialReference parse_crs(const std::string& text);

/// WGS84 with longitude and latitude in degrees, in this order.
OGRSpatialReference make_wgs84();

}  // namespace vinerow::io
