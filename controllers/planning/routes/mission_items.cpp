#include "controllers/planning/routes/mission_items.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/io/missions/gis_mission.h"
#include "engine/io/missions/mav_command.h"
#include "engine/math/angles.h"
#include "engine/math/polygon.h"

namespace vinerow::controllers {
namespace {

using Eigen::Vector2d;

constexpr double kFarthest_m = 20e3;  // beyond it a plane is no approximation of the Earth

/// Sets the position of an item and the reference of its altitude.
void set_place(const io::MissionItem& item, const LocalFrame& frame, MissionPlace& place) {
  io::MavAltitude altitude = io::MavAltitude::kNone;
  io::find_mav_altitude(item.frame, altitude);
  place.item = item.number;
  place.has_place = altitude != io::MavAltitude::kNone && io::has_place(item);
  place.altitude_m = std::isfinite(item.params[6]) ? item.params[6] : 0.0;
  using Reference = MissionPlace::Reference;
  place.reference = altitude == io::MavAltitude::kHome           ? Reference::kHome
                    : altitude == io::MavAltitude::kTerrain      ? Reference::kGround
                    : altitude == io::MavAltitude::kMeanSeaLevel ? Reference::kWorld
                                                                 : Reference::kKeep;
  if (!place.has_place) {
    if (place.reference == Reference::kWorld) place.altitude_m -= frame.origin().altitude_m;
    return;
  }
  Geodetic at = io::place_of(item);
  // The horizontal position depends slightly on the height: 1 mm per 6 m at 1 km from the origin.
  if (place.reference != Reference::kWorld) at.altitude_m += frame.origin().altitude_m;
  const Eigen::Vector3d p_W = frame.to_local(at);
  place.p_W = p_W.head<2>();
  if (place.reference == Reference::kWorld) place.altitude_m = p_W.z();
}

void require_near(const io::MissionFile& mission, const io::MissionItem& item,
                  const MissionPlace& place, const GeoOrigin& origin, const std::string& who) {
  if (!place.has_place || place.p_W.norm() <= kFarthest_m) return;
  throw ConfigError(fmt::format(
      "{}: item {} of '{}' is {:.1f} km from the world's origin ({:.6f}, {:.6f}), must be within "
      "{:g} km; a world with origin_latitude_deg = {:.6f}, origin_longitude_deg = {:.6f} would fit",
      who, item.number, mission.file.string(), 1e-3 * place.p_W.norm(),
      deg_from_rad(origin.latitude_rad), deg_from_rad(origin.longitude_rad), 1e-3 * kFarthest_m,
      item.params[4], item.params[5]));
}

}  // namespace

MissionPlaces place_mission(const io::MissionFile& mission, const GeoOrigin& origin, bool winged,
                            const std::string& who) {
  const LocalFrame frame(origin);
  MissionPlaces result;
  const auto& stated_mps = winged ? mission.cruise_speed_mps : mission.hover_speed_mps;
  double speed_mps = stated_mps.value_or(0.0);
  result.first_speed_mps = speed_mps;
  bool camera = false, sprays = false, is_speed_given = false;
  constexpr int kSprayer = 216;
  if (io::is_gis_mission(mission.file)) {
    result.height_hint = "; the property height_m of a line or point sets its height";
  }
  int flown = 0;
  for (const io::MissionItem& item : mission.items) {
    const io::MavCommand& command = *io::find_mav_command(item.command);
    MissionPlace place;
    place.speed_mps = speed_mps;
    place.is_speed_given = is_speed_given;
    place.sprays = sprays;
    place.camera = camera;
    using enum io::MavAction;
    switch (command.action) {
      case kCannotBeFlown:
        throw ConfigError(fmt::format("{}: item {} of '{}', {}, cannot be flown", who, item.number,
                                      mission.file.string(),
                                      io::describe_mav_command(item.command)));
      case kNoMotion:
        if (item.command == kSprayer) {
          sprays = item.params[0] > 0.0;
          result.uses_sprayer = true;
          (result.places.empty() ? result.first_sprays : result.places.back().sprays) = sprays;
        }
        ++result.ignored_items;
        continue;
      case kSpeed: {
        // Type 0 airspeed, 1 ground speed, others climb and descent; -1 keeps the speed.
        const bool is_speed = item.params[0] == 0.0 || item.params[0] == 1.0;
        if (is_speed && item.params[1] > 0.0) {
          speed_mps = item.params[1];
          is_speed_given = true;
        }
        if (!result.places.empty()) {
          result.places.back().speed_mps = speed_mps;
          result.places.back().is_speed_given = is_speed_given;
        } else if (is_speed_given) {
          result.first_given_mps = speed_mps;
        }
        continue;
      }
      case kTrigger:
        camera = item.params[0] > 0.0;
        result.uses_camera |= camera;
        if (!result.places.empty()) result.places.back().camera = camera;
        continue;
      case kLoiter:
        ++result.loiters;
        break;
      case kTakeOff:
        place.task = MissionPlace::Task::kTakeOff;
        break;
      case kReturn:
        place.task = MissionPlace::Task::kReturn;
        break;
      case kLand:
        place.task = MissionPlace::Task::kLand;
        break;
      case kWaypoint:
        if (!winged && item.command == io::kNavWaypoint && item.params[0] > 0.0) {
          ++result.ignored_holds;
        }
        break;
    }
    set_place(item, frame, place);
    if (command.action == kReturn) place.has_place = false;
    require_near(mission, item, place, origin, who);
    flown += place.task == MissionPlace::Task::kFly ||
             (place.task == MissionPlace::Task::kTakeOff && place.has_place);
    result.places.push_back(place);
    // Later items are never reached.
    if (place.task == MissionPlace::Task::kReturn || place.task == MissionPlace::Task::kLand) break;
    constexpr int kLoiterForever = 17;
    if (item.command == kLoiterForever) break;
  }
  if (result.first_speed_mps == 0.0 && !result.places.empty()) {
    result.first_speed_mps = result.places.front().speed_mps;
  }
  if (flown == 0) {
    throw ConfigError(fmt::format("{}: '{}' has no waypoint: there is nowhere to go", who,
                                  mission.file.string()));
  }
  return result;
}

std::optional<std::string> find_broken_fence(const io::MissionFile& mission,
                                             const GeoOrigin& origin, const Vector2d& from_W,
                                             const Vector2d& to_W) {
  if (mission.fence_polygons.empty() && mission.fence_circles.empty()) return std::nullopt;
  const LocalFrame frame(origin);
  const auto local = [&](Geodetic place) {
    place.altitude_m = origin.altitude_m;
    return Vector2d(frame.to_local(place).head<2>());
  };
  constexpr double kStep_m = 0.5;
  const int steps = std::max(1, static_cast<int>(std::ceil((to_W - from_W).norm() / kStep_m)));
  const auto find = [&](bool inclusion, const std::string& name,
                        const auto& is_inside) -> std::optional<std::string> {
    for (int k = 0; k <= steps; ++k) {
      const Vector2d p = from_W + static_cast<double>(k) / steps * (to_W - from_W);
      if (is_inside(p) == inclusion) continue;
      return fmt::format("{} {} at ({:.1f}, {:.1f})", inclusion ? "inclusion" : "exclusion", name,
                         p.x(), p.y());
    }
    return std::nullopt;
  };
  int number = 0;
  for (const io::FencePolygon& fence : mission.fence_polygons) {
    Polygon polygon;
    for (const Geodetic& point : fence.points) polygon.push_back(local(point));
    if (auto found = find(fence.inclusion, fmt::format("polygon {}", ++number),
                          [&](const Vector2d& p) { return contains(polygon, p); })) {
      return found;
    }
  }
  number = 0;
  for (const io::FenceCircle& fence : mission.fence_circles) {
    const Vector2d centre = local(fence.centre);
    if (auto found =
            find(fence.inclusion, fmt::format("circle {}", ++number),
                 [&](const Vector2d& p) { return (p - centre).norm() < fence.radius_m; })) {
      return found;
    }
  }
  return std::nullopt;
}

}  // namespace vinerow::controllers
