#include "engine/io/missions/mission_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/io/missions/gis_mission.h"
#include "engine/io/missions/mav_command.h"
#include "engine/io/missions/mission_item_check.h"
#include "engine/io/missions/qgc_plan.h"
#include "engine/io/missions/qgc_wpl.h"
#include "engine/math/angles.h"
#include "engine/math/geo.h"
#include "engine/math/polygon.h"

namespace vinerow::io {
namespace {

MissionFile read_any_mission(const std::filesystem::path& file) {
  if (is_gis_mission(file)) return read_gis_mission(file);
  std::optional<std::string> bytes = read_bytes(file);
  if (!bytes) throw ConfigError(fmt::format("mission file '{}' does not exist", file.string()));
  std::string& text = *bytes;
  const std::string kByteOrderMark = "\xEF\xBB\xBF";
  if (text.rfind(kByteOrderMark, 0) == 0) text.erase(0, kByteOrderMark.size());
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos) {
    throw ConfigError(fmt::format("mission file '{}' is empty", file.string()));
  }
  if (text.compare(begin, 3, "QGC") == 0) return parse_qgc_wpl(text.substr(begin), file);
  if (text[begin] == '{') return parse_qgc_plan(text, file);
  throw ConfigError(fmt::format(
      "mission file '{}' is neither a QGroundControl plan (JSON) nor a 'QGC WPL 110' text; lines "
      "and points of a map are read from .gpkg, .kml, .kmz, .shp and .geojson",
      file.string()));
}

/// A polygon that crosses itself has no side that is inside.
void check_fence(const FencePolygon& fence, int number, const std::filesystem::path& file) {
  constexpr std::size_t kMost = 5'000;  // each edge is compared with each other
  if (fence.points.size() > kMost) return;
  const LocalFrame frame({fence.points[0].latitude_rad, fence.points[0].longitude_rad, 0.0});
  Polygon points;
  for (const Geodetic& point : fence.points) points.push_back(frame.to_local(point).head<2>());
  const Polygon polygon = without_repeats(points);
  if (polygon.size() < 4) return;  // a triangle cannot
  const auto crossing = find_crossing(polygon);
  if (!crossing) return;
  const auto number_of = [&](int corner) {
    return std::find(points.begin(), points.end(), polygon[corner]) - points.begin() + 1;
  };
  throw ConfigError(fmt::format(
      "mission '{}', fence polygon {}: the edge from its point {} meets the edge from its point "
      "{}, points must be in order around it",
      file.string(), number, number_of(crossing->first), number_of(crossing->second)));
}

}  // namespace

std::string mission_place(const std::filesystem::path& file, int number) {
  return fmt::format("mission '{}', item {}", file.string(), number);
}

void check_mission_item(const MissionItem& item, const std::filesystem::path& file) {
  const std::string where = mission_place(file, item.number);
  const MavCommand* command = find_mav_command(item.command);
  if (command == nullptr) {
    throw ConfigError(
        fmt::format("{}: command {} is not known; known are take-off 22, waypoints 16 and 82, "
                    "loiter 17 to 19 and 31, return 20, land 21, speed 178, and camera and payload "
                    "commands such as 206, 203, 530 and 2000",
                    where, item.command));
  }
  MavAltitude altitude;
  if (!find_mav_altitude(item.frame, altitude)) {
    throw ConfigError(fmt::format(
        "{} ({}): frame {} is not known; known are 0 and 5 (above mean sea level), 3 and 6 (above "
        "home), 10 and 11 (above the terrain) and 2 (no position)",
        where, command->name, item.frame));
  }
  for (std::size_t i = 0; i < item.params.size(); ++i) {
    if (std::isinf(item.params[i])) {
      throw ConfigError(fmt::format("{} ({}): parameter {} = {} is not a finite number", where,
                                    command->name, i + 1, item.params[i]));
    }
  }
  using enum MavAction;
  const bool flies_there = command->action == kWaypoint || command->action == kLoiter;
  if (flies_there && (altitude == MavAltitude::kNone || !has_place(item))) {
    throw ConfigError(
        fmt::format("{} ({}): it has no position (latitude {}, longitude {}, frame {})", where,
                    command->name, item.params[4], item.params[5], item.frame));
  }
  const bool climbs = flies_there || command->action == kTakeOff;
  if (climbs && !std::isfinite(item.params[6])) {
    throw ConfigError(fmt::format("{} ({}): it has no altitude", where, command->name));
  }
  const bool is_placed = climbs || command->action == kLand;
  if (is_placed && has_place(item) &&
      (std::abs(item.params[4]) > 90.0 || std::abs(item.params[5]) > 180.0)) {
    throw ConfigError(
        fmt::format("{} ({}): latitude {} deg, longitude {} deg, must be within +-90 and +-180 deg",
                    where, command->name, item.params[4], item.params[5]));
  }
}

bool has_place(const MissionItem& item) {
  const double latitude = item.params[4], longitude = item.params[5];
  return std::isfinite(latitude) && std::isfinite(longitude) &&
         (latitude != 0.0 || longitude != 0.0);
}

Geodetic place_of(const MissionItem& item) {
  const double altitude_m = std::isfinite(item.params[6]) ? item.params[6] : 0.0;
  return {rad_from_deg(item.params[4]), rad_from_deg(item.params[5]), altitude_m};
}

MissionFile read_mission(const std::filesystem::path& file) {
  MissionFile mission = read_any_mission(file);
  int number = 0;
  for (const FencePolygon& fence : mission.fence_polygons) check_fence(fence, ++number, file);
  return mission;
}

}  // namespace vinerow::io
