#include "controllers/autopilot/mavlink/mission_items.h"

#include <cmath>

#include "engine/io/missions/mav_command.h"

namespace vinerow::controllers {
namespace {

/// "Keep" and "default" (null in a .plan) are 0 for ArduPilot, which refuses NaN.
float number_or_zero(double value) {
  return std::isfinite(value) ? static_cast<float>(value) : 0.0F;
}

mavlink::MissionItemInt item_of(const io::MissionItem& from, const FirmwareFrame& frame) {
  mavlink::MissionItemInt item;
  item.frame = static_cast<std::uint8_t>(from.frame);
  item.command = static_cast<std::uint16_t>(from.command);
  item.autocontinue = from.auto_continue ? 1 : 0;
  item.param1 = number_or_zero(from.params[0]);
  item.param2 = number_or_zero(from.params[1]);
  item.param3 = number_or_zero(from.params[2]);
  item.param4 = number_or_zero(from.params[3]);
  item.z = number_or_zero(from.params[6]);
  if (io::has_place(from)) {
    const PlaceE7 place = frame.place_of(io::place_of(from));
    item.x = place.latitude;
    item.y = place.longitude;
  } else {
    item.x = static_cast<std::int32_t>(number_or_zero(from.params[4]));
    item.y = static_cast<std::int32_t>(number_or_zero(from.params[5]));
  }
  return item;
}

}  // namespace

std::vector<mavlink::MissionItemInt> make_mission_items(const io::MissionFile& mission,
                                                        const FirmwareFrame& frame, bool has_home) {
  std::vector<mavlink::MissionItemInt> items;
  if (has_home) {
    mavlink::MissionItemInt home;
    home.command = io::kNavWaypoint;
    home.frame = io::kFrameMeanSeaLevel;
    home.autocontinue = 1;
    const Geodetic origin = frame.wgs84().to_geodetic(Eigen::Vector3d::Zero());
    const Geodetic place = mission.planned_home.value_or(origin);
    const PlaceE7 place_e7 = frame.place_of(place);
    home.x = place_e7.latitude;
    home.y = place_e7.longitude;
    home.z = static_cast<float>(place.altitude_m);
    items.push_back(home);
  }
  for (const io::MissionItem& item : mission.items) items.push_back(item_of(item, frame));
  for (std::size_t i = 0; i < items.size(); ++i) items[i].seq = static_cast<std::uint16_t>(i);
  return items;
}

}  // namespace vinerow::controllers
