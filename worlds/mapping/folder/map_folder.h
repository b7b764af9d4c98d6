#pragma once
/// Folder of a Vinerow map on disk, in file formats that other programs can open.
///
///     map.json         rows, alleys, boundary, accuracy, figures (map_json.h)
///     report.json      the figures alone
///     meshes/row_03_hull_00.ply   row meshes in W (map_files.h)
///     terrain.tif      ground, GeoTIFF (height_raster.h)
///     occupancy.yaml, occupancy.pgm   ROS map (ros_map.h)
///     rows.geojson     rows, ends, alleys, boundary in WGS84, if the origin is known
///     rows.csv         a line for each row: block, length, canopy, volume, gaps
///     gis/             layers and rasters in the cloud's reference system (map_gis.h)
///     points.json, points.classes   class of each point, in the map of a job (map_points.h)
///     block_0, block_1   folders of the same kind, if there are several blocks of rows

#include <filesystem>

#include "worlds/mapping/model/cloud_map.h"

namespace vinerow::mapping {

/// Writes a map to a folder, which is created if necessary. Its files of these names are replaced,
/// or removed if the map has no content for them; other files are not touched. The same map gives
/// the same bytes.
/// @throws ConfigError if check_map() rejects the map or a file cannot be written
void save_map(const CloudMap& map, const std::filesystem::path& folder);

/// Reads what save_map() wrote: the same numbers bit for bit, meshes in the order of the rows'
/// numbers, without phases. Latitude and longitude of an origin that was not given in degrees are
/// exact to 1e-16 rad.
/// @throws ConfigError in one sentence: no map in the folder, a file missing, truncated or of
/// another version, files that do not belong together, a map that check_map() rejects
CloudMap load_map(const std::filesystem::path& folder);

/// "FOLDER/block_0".
std::filesystem::path block_folder(const std::filesystem::path& folder, int block);

/// Number of blocks of a map's rows.
int count_blocks(const CloudMap& map);

/// Rows (type "row", with the figures of row_values()), their end points ("row_end"), alleys
/// ("mid_row_line") and boundary
/// ("boundary") as a FeatureCollection; altitudes above the ellipsoid. The world `surveyed` reads
/// the rows. @pre map.has_origin
std::string map_to_geojson(const CloudMap& map);

}  // namespace vinerow::mapping
