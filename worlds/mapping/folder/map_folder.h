#pragma once
/// A Vinerow map on disk: a folder of files that other programs open too.
///
///     map.json         rows, alleys, boundary, accuracy, figures (map_json.h)
///     report.json      the figures alone
///     meshes/row_03_hull_00.ply   row meshes in W (map_files.h)
///     terrain.tif      ground, GeoTIFF (height_raster.h)
///     occupancy.yaml, occupancy.pgm   ROS map (ros_map.h)
///     rows.geojson     rows, ends, alleys, boundary in WGS84, where the origin is known
///     rows.csv         a line for each row: block, length, canopy, volume, gaps
///     gis/             layers and rasters in the cloud's reference system (map_gis.h)
///     points.json, points.classes   what each point is, in the map of a job (map_points.h)
///     block_0, block_1   where there are several blocks of rows: each as such a folder

#include <filesystem>

#include "worlds/mapping/model/cloud_map.h"

namespace vinerow::mapping {

/// Into a folder that is made if need be. What it holds of these files is replaced; those that the
/// map has nothing for are removed, other files are left alone. Same map, same bytes.
/// @throws ConfigError where the map is not sound (check_map()) or a file cannot be written
void save_map(const CloudMap& map, const std::filesystem::path& folder);

/// What save_map() wrote: the same numbers bit for bit, meshes in the order of the rows' numbers,
/// without phases; latitude and longitude of an origin that was never in degrees to 1e-16 rad.
/// @throws ConfigError in one sentence: no map there, a file missing, cut off or of another
/// version, files that do not belong together, what check_map() refuses
CloudMap load_map(const std::filesystem::path& folder);

/// "FOLDER/block_0".
std::filesystem::path block_folder(const std::filesystem::path& folder, int block);

/// How many blocks the rows of a map are of.
int count_blocks(const CloudMap& map);

/// Rows (type "row", with the figures of row_values()), their end points ("row_end"), alleys
/// ("mid_row_line") and boundary
/// ("boundary") as a FeatureCollection; altitudes above the ellipsoid. The world `surveyed` reads
/// the rows. @pre map.has_origin
std::string map_to_geojson(const CloudMap& map);

}  // namespace vinerow::mapping
