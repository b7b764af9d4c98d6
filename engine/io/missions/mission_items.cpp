#include "engine/io/missions/mission_items.h"

#include <cmath>

#include "engine/io/missions/mav_command.h"
#include "engine/math/angles.h"

namespace vinerow::io {
namespace {

std::int32_t e7(double angle_rad) {
  return static_cast<std::int32_t>(std::lround(deg_from_rad(angle_rad) * 1e7));
}

/// "Keep" and "default" (null in a .plan) are 0 for ArduPilot, which refuses NaN.
float number_or_zero(double value) {
  return std::isfinite(value) ? static_cast<float>(value) : 0.0F;
}

mavlink::MissionItemInt item_of(const MissionItem& from,
                                const std::function<PlaceE7(const Geodetic&)>& place_of_point) {
  mavlink::MissionItemInt item;
  item.frame = static_cast<std::uint8_t>(from.frame);
  item.command = static_cast<std::uint16_t>(from.command);
  item.autocontinue = from.auto_continue ? 1 : 0;
  item.param1 = number_or_zero(from.params[0]);
  item.param2 = number_or_zero(from.params[1]);
  item.param3 = number_or_zero(from.params[2]);
  item.param4 = number_or_zero(from.params[3]);
  item.z = number_or_zero(from.params[6]);
  if (has_place(from)) {
    const PlaceE7 place = place_of_point(place_of(from));
    item.x = place.latitude;
    item.y = place.longitude;
  } else {
    item.x = static_cast<std::int32_t>(number_or_zero(from.params[4]));
    item.y = static_cast<std::int32_t>(number_or_zero(from.params[5]));
  }
  return item;
}

}  // namespace

PlaceE7 place_e7(const Geodetic& point) {
  return {e7(point.latitude_rad), e7(point.longitude_rad)};
}

std::vector<mavlink::MissionItemInt> make_mission_items(
    const MissionFile& mission, std::optional<Geodetic> home,
    const std::function<PlaceE7(const Geodetic&)>& place_of_point) {
  std::vector<mavlink::MissionItemInt> items;
  if (home) {
    mavlink::MissionItemInt item;
    item.command = kNavWaypoint;
    item.frame = kFrameMeanSeaLevel;
    item.autocontinue = 1;
    const PlaceE7 place = place_of_point(*home);
    item.x = place.latitude;
    item.y = place.longitude;
    item.z = static_cast<float>(home->altitude_m);
    items.push_back(item);
  }
  for (const MissionItem& item : mission.items) items.push_back(item_of(item, place_of_point));
  for (std::size_t i = 0; i < items.size(); ++i) items[i].seq = static_cast<std::uint16_t>(i);
  return items;
}

}  // namespace vinerow::io
