#pragma once
/// Features of a survey from any of the files they come in: GeoJSON, KML and KMZ, shapefiles,
/// GeoPackages.

#include <filesystem>
#include <string>
#include <vector>

#include "engine/io/geo/geojson.h"

namespace vinerow::io {

/// Reads by the file's ending: .kml, .kmz, .shp and .gpkg by GDAL, from their own coordinate
/// reference system to WGS84 and with the names of their properties in lower case; everything else
/// as GeoJSON. All layers count, in order.
/// @throws ConfigError naming the file (and feature): missing, broken, no coordinate reference
/// system, coordinates that do not convert; as read_geojson
std::vector<GeoFeature> read_features(const std::filesystem::path& file);

/// "GeoJSON file 'a.json'" or "file 'a.kml'", for sentences.
std::string name_of_feature_file(const std::filesystem::path& file);

}  // namespace vinerow::io
