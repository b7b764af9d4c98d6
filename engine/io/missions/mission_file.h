#pragma once
/// Mission files: QGroundControl's `.plan`, the text format `QGC WPL 110`, and missions drawn in a
/// GIS program (gis_mission.h).

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/geo.h"

namespace vinerow::io {

/// One MAVLink mission item.
struct MissionItem {
  int command = 16;  ///< MAV_CMD, see mav_command.h
  int frame = 3;     ///< MAV_FRAME
  /// Parameters as in the file, in the command's own units; NaN for JSON's null ("keep",
  /// "default"). For items with a position, params[4] and params[5] are latitude and longitude in
  /// degrees and params[6] is the altitude in m.
  std::array<double, 7> params = {0, 0, 0, 0, 0, 0, 0};
  bool auto_continue = true;
  int number = 0;  ///< of the item in its file, from 1; items of a survey have the survey's number
};

struct FencePolygon {
  bool inclusion = true;
  std::vector<Geodetic> points;  ///< altitude 0
};

struct FenceCircle {
  bool inclusion = true;
  Geodetic centre;
  double radius_m = 0.0;
};

struct MissionFile {
  std::filesystem::path file;
  std::string format;  ///< "QGroundControl plan", "QGC WPL 110", "lines and points of a map"
  std::vector<MissionItem> items;
  std::optional<Geodetic> planned_home;    ///< altitude above mean sea level
  std::optional<double> cruise_speed_mps;  ///< of fixed-wing vehicles
  std::optional<double> hover_speed_mps;
  bool rotorcraft = false;  ///< vehicle type of a plan to be written
  std::vector<FencePolygon> fence_polygons;
  std::vector<FenceCircle> fence_circles;
  std::vector<Geodetic> rally_points;
};

/// Reads any of the formats; extension and content select it.
/// @throws ConfigError in one sentence, with the file, the item's number and the allowed values:
/// missing file, unknown format, versions other than `.plan` 1, mission 2, survey 5, fences 2;
/// missing parts; unknown commands and frames; complex items other than surveys; invalid numbers;
/// fences that cross themselves
MissionFile read_mission(const std::filesystem::path& file);

/// True if an item has a position: params[4] and params[5] are finite and not both zero.
bool has_place(const MissionItem& item);
/// @pre has_place()
Geodetic place_of(const MissionItem& item);

}  // namespace vinerow::io
