#pragma once
/// Items of a mission as MAVLink sends them.

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "engine/io/missions/mission_file.h"
#include "engine/mavlink/messages.h"

namespace vinerow::io {

/// As MAVLink sends places: 1e-7 degrees.
struct PlaceE7 {
  std::int32_t latitude = 0, longitude = 0;
  friend bool operator==(const PlaceE7&, const PlaceE7&) = default;
};

PlaceE7 place_e7(const Geodetic& point);

/// @param place_of_point  for autopilots whose places are not those of WGS84
/// @param home      item 0 of the mission, as ArduPilot has it; absent: the mission has no such
/// item
/// @returns items with their numbers
std::vector<mavlink::MissionItemInt> make_mission_items(
    const MissionFile& mission, std::optional<Geodetic> home,
    const std::function<PlaceE7(const Geodetic&)>& place_of_point = place_e7);

}  // namespace vinerow::io
