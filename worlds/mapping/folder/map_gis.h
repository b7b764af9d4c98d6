#pragma once
/// GIS export of a map: rasters and layers in the coordinate reference system of the cloud, in the
/// folder gis of the map.
///
///     dtm.tif    the ground
///     dsm.tif    the highest point of each pixel
///     chm.tif    dsm - dtm: height above the ground
///     map.gpkg   layers rows, row_ends, alleys, boundary

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "worlds/mapping/model/cloud_map.h"
#include "worlds/mapping/model/parcel_cloud.h"

namespace vinerow::mapping {

/// Figures of a row with their names in tables and layers, in order.
std::vector<std::pair<std::string, double>> row_values(const MappedRowFigures& row);

/// Table with a line for each row and its figures, for spreadsheets.
std::string rows_to_csv(const CloudMap& map);

/// Coordinate reference system of the files: that of the cloud if it is projected, else the UTM
/// zone of the map's origin; "" without an origin, and then coordinates are metres of the map.
std::string gis_crs(const CloudMap& map);

/// Writes rasters and layers. The same map and cloud give the same bytes. Pixels are 0.1 to 1 m, so
/// that most contain four points.
/// @param cloud  from which the map was made
/// @throws ConfigError naming a file that cannot be written
void save_gis(const CloudMap& map, const ParcelCloud& cloud, const std::filesystem::path& folder);

}  // namespace vinerow::mapping
