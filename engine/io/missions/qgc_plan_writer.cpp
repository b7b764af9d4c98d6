
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/whole_file.h"
#include "engine/io/missions/mav_command.h"
#include "engine/io/missions/qgc_plan.h"
#include "engine/math/angles.h"

namespace vinerow::io {
namespace {

using nlohmann::json;

json number_or_null(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

json format_item(const MissionItem& item, int jump_id) {
  json params = json::array();
  for (const double value : item.params) params.push_back(number_or_null(value));
  json entry = {{"autoContinue", item.auto_continue},
                {"command", item.command},
                {"doJumpId", jump_id},
                {"frame", item.frame},
                {"params", params},
                {"type", "SimpleItem"}};
  MavAltitude altitude = MavAltitude::kNone;
  find_mav_altitude(item.frame, altitude);
  if (altitude != MavAltitude::kNone && has_place(item)) {
    constexpr int kRelative = 1, kAbsolute = 2, kTerrainFrame = 4;  // QGroundControl's own numbers
    entry["AMSLAltAboveTerrain"] = nullptr;
    entry["Altitude"] = item.params[6];
    entry["AltitudeMode"] = altitude == MavAltitude::kHome           ? kRelative
                            : altitude == MavAltitude::kMeanSeaLevel ? kAbsolute
                                                                     : kTerrainFrame;
  }
  return entry;
}

json format_position(const Geodetic& place) {
  return json::array({deg_from_rad(place.latitude_rad), deg_from_rad(place.longitude_rad)});
}

json format_fences(const MissionFile& mission) {
  json polygons = json::array(), circles = json::array();
  for (const FencePolygon& fence : mission.fence_polygons) {
    json points = json::array();
    for (const Geodetic& point : fence.points) points.push_back(format_position(point));
    polygons.push_back({{"inclusion", fence.inclusion}, {"polygon", points}, {"version", 1}});
  }
  for (const FenceCircle& fence : mission.fence_circles) {
    circles.push_back(
        {{"circle", {{"center", format_position(fence.centre)}, {"radius", fence.radius_m}}},
         {"inclusion", fence.inclusion},
         {"version", 1}});
  }
  return {{"circles", circles}, {"polygons", polygons}, {"version", 2}};
}

}  // namespace

std::string format_qgc_plan(const MissionFile& mission) {
  constexpr int kGenericAutopilot = 0, kFixedWing = 1, kQuadrotor = 2,
                kDefaultHover_mps = 5;  // MAV_AUTOPILOT, MAV_TYPE
  json items = json::array();
  for (const MissionItem& item : mission.items) {
    items.push_back(format_item(item, static_cast<int>(items.size()) + 1));
  }
  json home = format_position(*mission.planned_home);
  home.push_back(mission.planned_home->altitude_m);
  json rally = json::array();
  for (const Geodetic& point : mission.rally_points) {
    rally.push_back(format_position(point));
    rally.back().push_back(point.altitude_m);
  }
  const json root = {{"fileType", "Plan"},
                     {"geoFence", format_fences(mission)},
                     {"groundStation", "QGroundControl"},
                     {"mission",
                      {{"cruiseSpeed", mission.cruise_speed_mps.value_or(15.0)},
                       {"firmwareType", kGenericAutopilot},
                       {"globalPlanAltitudeMode", 1},
                       {"hoverSpeed", mission.hover_speed_mps.value_or(kDefaultHover_mps)},
                       {"items", items},
                       {"plannedHomePosition", home},
                       {"vehicleType", mission.rotorcraft ? kQuadrotor : kFixedWing},
                       {"version", 2}}},
                     {"rallyPoints", {{"points", rally}, {"version", 2}}},
                     {"version", 1}};
  return root.dump(4) + "\n";
}

void write_qgc_plan(const MissionFile& mission, const std::filesystem::path& file) {
  write_whole_file(file, format_qgc_plan(mission), "mission file");
}

}  // namespace vinerow::io
