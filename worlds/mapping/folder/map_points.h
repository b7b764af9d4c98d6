#pragma once
/// Record of a map's points in its folder, with which they can be shown without making the map
/// again. The points themselves stay in their cloud.
///
///     points.json      options with which the cloud was read and the grid was made
///     points.classes   class of each point, one byte, in the order of the cloud

#include <filesystem>
#include <optional>
#include <vector>

#include "worlds/mapping/grid/occupancy.h"
#include "worlds/mapping/model/parcel_cloud.h"
#include "worlds/mapping/reading/read_cloud.h"

namespace vinerow::mapping {

struct MapPoints {
  CloudReadOptions reading;    ///< crs, origin and thin are kept; others have defaults
  OccupancyOptions occupancy;  ///< cell_m, virtual_walls and first_wall are kept
  std::vector<PointClass> classes;
};

/// @param folder  existing folder of the map
/// @throws ConfigError if a file cannot be written
void save_map_points(const MapPoints& points, const std::filesystem::path& folder);

/// Reads the same bits; null if the folder has no such files.
/// @throws ConfigError in one sentence: a file missing, of another version, or altered
std::optional<MapPoints> load_map_points(const std::filesystem::path& folder);

/// Points with their classes and colours. @param cloud  from which the map was made
/// @throws ConfigError as read_parcel_cloud(), and if it has another number of points
ParcelCloud read_classified_cloud(const MapPoints& points, const std::filesystem::path& cloud);

}  // namespace vinerow::mapping
