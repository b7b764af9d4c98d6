#pragma once
/// A map for surveyors' programs: rasters and layers in the coordinate reference system of the
/// cloud, in folder gis of the map.
///
///     dtm.tif    the ground
///     dsm.tif    the highest point of each pixel
///     chm.tif    dsm - dtm: height of what stands there
///     map.gpkg   layers rows, row_ends, alleys, boundary

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "worlds/mapping/model/cloud_map.h"
#include "worlds/mapping/model/parcel_cloud.h"

namespace vinerow::mapping {

/// Figures of a row under the names that tables and layers give them, in their order.
std::vector<std::pair<std::string, double>> row_values(const MappedRowFigures& row);

/// A line for each row with its figures: what a spreadsheet opens.
std::string rows_to_csv(const CloudMap& map);

/// The system that the files are in: the cloud's where it is projected, else the UTM zone of the
/// map's origin; "" without an origin, where coordinates are metres of the map.
std::string gis_crs(const CloudMap& map);

/// Same map, same cloud: the same bytes. Pixels are of 0.1 to 1 m, so that most hold four points.
/// @param cloud  that the map was made of
/// @throws ConfigError naming a file that cannot be written
void save_gis(const CloudMap& map, const ParcelCloud& cloud, const std::filesystem::path& folder);

}  // namespace vinerow::mapping
