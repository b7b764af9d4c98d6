#pragma once
/// Reader of missions drawn in a GIS program: lines to follow in file order, or points to visit,
/// with fences as polygons.

#include "engine/io/missions/mission_file.h"

namespace vinerow::io {

/// True if read_mission() reads the file as such a mission: .gpkg, .kml, .kmz, .shp, .geojson.
bool is_gis_mission(const std::filesystem::path& file);

/// Lines become waypoints from start to end, one line after the other. If there is no line, points
/// become waypoints, ordered by their property `order` or `number` if all have it, else in file
/// order. Properties of a line or point:
///   speed_mps   sets the speed from there on (MAV_CMD 178)
///   sprayer     of a line, true or false: on along the line, off after it (MAV_CMD 216)
///   height_m    above home; without it the third coordinate, above mean sea level or as
///               <altitudeMode> of a KML file defines it, else 0 above home
///   at_end      of the last one: `land` at its end (MAV_CMD 21), or `return` to the start (20)
/// Polygons with the property fence = inclusion or exclusion are fences; other polygons are
/// ignored.
/// @throws ConfigError as read_features(); also if there is no line or point, or a property has an
/// invalid value
MissionFile read_gis_mission(const std::filesystem::path& file);

}  // namespace vinerow::io
