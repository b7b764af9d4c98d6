#pragma once
/// Missions drawn in a geographic information system: lines to follow in the order of the file, or
/// points to visit, with fences as polygons.

#include "engine/io/missions/mission_file.h"

namespace vinerow::io {

/// Whether read_mission() takes a file for one of these: .gpkg, .kml, .kmz, .shp, .geojson.
bool is_gis_mission(const std::filesystem::path& file);

/// Lines become waypoints from end to end, one line after the other; where there is no line, the
/// points do, in the order of their property `order` or `number` where all have it, else of the
/// file. Properties of a line or point:
///   speed_mps   sets the speed from there on (MAV_CMD 178)
///   sprayer     of a line, true or false: works along it, and not behind it (MAV_CMD 216)
///   height_m    above home; without it the third coordinate, above mean sea level, else 0 above
///               home
/// Polygons with the property fence = inclusion or exclusion are fences; others do not count.
/// @throws ConfigError as read_features(); no line or point, a property that is no such value
MissionFile read_gis_mission(const std::filesystem::path& file);

}  // namespace vinerow::io
