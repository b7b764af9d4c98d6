#pragma once
/// Items of a mission as places in W, in order.

#include <optional>
#include <string>
#include <vector>

#include "engine/io/missions/mission_file.h"
#include "engine/math/geo_origin.h"

namespace vinerow::controllers {

/// A place of a mission.
struct MissionPlace {
  enum class Task { kFly, kTakeOff, kReturn, kLand };
  Task task = Task::kFly;
  bool has_place = true;  ///< false: take off, return, land without latitude and longitude
  Eigen::Vector2d p_W = {0, 0};
  double altitude_m = 0.0;  ///< above `reference`
  enum class Reference { kWorld, kHome, kGround, kKeep } reference = Reference::kHome;
  double speed_mps = 0.0;  ///< from here on; 0: not given
  bool is_speed_given =
      false;            ///< true: by an item; false: the file's default for the kind of vehicle
  bool sprays = false;  ///< whether the sprayer works from here on
  bool camera = false;  ///< whether the camera is triggered by distance from here on
  int item = 0;         ///< number of the item, for messages
};

struct MissionPlaces {
  std::vector<MissionPlace> places;
  double first_speed_mps = 0.0;  ///< to the first place
  double first_given_mps = 0.0;  ///< the same if an item sets it; else 0
  bool first_sprays = false;     ///< whether the sprayer works on the path to it
  bool uses_camera = false;      ///< whether any item triggers it by distance
  bool uses_sprayer = false;     ///< whether any item switches it
  int ignored_items = 0;         ///< items that do not move the vehicle
  int loiters = 0;               ///< loiter items, treated as waypoints
  std::string height_hint;       ///< "; the property ..." of files without items, for messages
  int ignored_holds = 0;         ///< waypoints at which other than winged vehicles should wait
};

/// @param winged  true: the cruise speed counts before any item sets a speed; false: the hover
/// speed @throws ConfigError as make_mission_route()
MissionPlaces place_mission(const io::MissionFile& mission, const GeoOrigin& origin, bool winged,
                            const std::string& who);

/// Fence that a straight line violates: all of it must be inside inclusion fences and outside
/// exclusion fences. Checked every 0.5 m. @returns "inclusion polygon 1 at (x, y)"
std::optional<std::string> find_broken_fence(const io::MissionFile& mission,
                                             const GeoOrigin& origin, const Eigen::Vector2d& from_W,
                                             const Eigen::Vector2d& to_W);

}  // namespace vinerow::controllers
