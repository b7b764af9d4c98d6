#pragma once
/// What a map's folder keeps of the points that it was made of: enough to show them again without
/// making the map a second time. The points themselves stay in their cloud.
///
///     points.json      how the cloud was read, how the grid was made
///     points.classes   a byte for each point, its class, in the cloud's order

#include <filesystem>
#include <optional>
#include <vector>

#include "worlds/mapping/grid/occupancy.h"
#include "worlds/mapping/model/parcel_cloud.h"
#include "worlds/mapping/reading/read_cloud.h"

namespace vinerow::mapping {

struct MapPoints {
  CloudReadOptions reading;    ///< crs, origin and thin are kept, all else is as usual
  OccupancyOptions occupancy;  ///< cell_m, virtual_walls and first_wall are kept
  std::vector<PointClass> classes;
};

/// @param folder  of the map, which is there
/// @throws ConfigError where a file cannot be written
void save_map_points(const MapPoints& points, const std::filesystem::path& folder);

/// The same bits; nothing where the folder keeps none.
/// @throws ConfigError in one sentence: a file missing, of another version or not as it was written
std::optional<MapPoints> load_map_points(const std::filesystem::path& folder);

/// The points with their classes and colours. @param cloud  that the map was made of
/// @throws ConfigError as read_parcel_cloud(), and where it has another number of points
ParcelCloud read_classified_cloud(const MapPoints& points, const std::filesystem::path& cloud);

}  // namespace vinerow::mapping
