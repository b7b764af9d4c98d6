#pragma once
/// Reader of survey features from GeoJSON, KML, KMZ, shapefiles and GeoPackages.

#include <filesystem>
#include <string>
#include <vector>

#include "engine/io/geo/geojson.h"

namespace vinerow::io {

/// Reads all layers of a file, in order. The extension selects the format: GDAL reads .kml, .kmz,
/// .shp and .gpkg, transforms them from their own coordinate reference system to WGS84, and
/// property names become lower case. All other files are read as GeoJSON.
/// @throws ConfigError naming the file (and feature): missing, broken, no coordinate reference
/// system, coordinates that cannot be transformed; and as read_geojson
std::vector<GeoFeature> read_features(const std::filesystem::path& file);

/// "GeoJSON file 'a.json'" or "file 'a.kml'", for messages.
std::string name_of_feature_file(const std::filesystem::path& file);

}  // namespace vinerow::io
