#pragma once
/// A mission's items as places in W, in the order flown.

#include <optional>
#include <string>
#include <vector>

#include "engine/io/missions/mission_file.h"
#include "engine/math/geo_origin.h"

namespace vinerow::controllers {

/// A place to fly to.
struct MissionPlace {
  enum class Task { kFly, kTakeOff, kReturn, kLand };
  Task task = Task::kFly;
  bool has_place = true;  ///< false: take off, return, land without latitude and longitude
  Eigen::Vector2d p_W = {0, 0};
  double altitude_m = 0.0;  ///< over what `reference` says
  enum class Reference { kWorld, kHome, kGround, kKeep } reference = Reference::kHome;
  double speed_mps = 0.0;      ///< from here on; 0: not told
  bool is_speed_said = false;  ///< by an item; else it is what the file says of all such vehicles
  bool sprays = false;         ///< whether the sprayer works from here on
  bool camera = false;         ///< whether the camera is triggered by distance from here on
  int item = 0;                ///< number of the item, for sentences
};

struct MissionPlaces {
  std::vector<MissionPlace> places;
  double first_speed_mps = 0.0;  ///< to the first place
  double first_said_mps = 0.0;   ///< the same where an item says it; else 0
  bool first_sprays = false;     ///< whether the sprayer works on the way there
  bool uses_camera = false;      ///< whether any item triggers it by distance
  bool uses_sprayer = false;     ///< whether any item switches it
  int ignored_items = 0;         ///< do not move the vehicle
  int loiters = 0;               ///< flown as waypoints
};

/// @param winged  whose cruise speed counts before any item sets one; others' is the hover speed
/// @throws ConfigError as make_mission_route() says
MissionPlaces place_mission(const io::MissionFile& mission, const GeoOrigin& origin, bool winged,
                            const std::string& who);

/// Which fence a straight way breaks: inclusion fences must hold all of it, exclusion fences none.
/// Looked at each 0.5 m. @returns "inclusion polygon 1 at (x, y)"
std::optional<std::string> find_broken_fence(const io::MissionFile& mission,
                                             const GeoOrigin& origin, const Eigen::Vector2d& from_W,
                                             const Eigen::Vector2d& to_W);

}  // namespace vinerow::controllers
