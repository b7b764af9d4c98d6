#include <fmt/format.h>

#include <cmath>

#include "engine/api/map.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/math/angles.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow {
namespace {

struct Heading {
  Eigen::Vector2d p_W;
  double yaw_rad;
};

Heading find_on_alley(const io::SpawnConfig& spawn, const WorldModel& world,
                      const std::string& vehicle) {
  const auto& alleys = world.rows->alleys;
  if (alleys.empty()) {
    throw ConfigError(fmt::format(
        "{}: vehicles.{}.spawn.alley = {}, but world '{}' has {} row{} and so no alley between two: "
        "give it more rows or the vehicle a spawn of {{x_m, y_m}}",
        spawn.where.text(), vehicle, *spawn.alley, world.name, world.rows->rows.size(),
        world.rows->rows.size() == 1 ? "" : "s"));
  }
  if (*spawn.alley < 0 || *spawn.alley >= static_cast<int>(alleys.size())) {
    throw ConfigError(
        fmt::format("{}: vehicles.{}.spawn.alley = {}, but world '{}' has {} alleys (0 to {})",
                    spawn.where.text(), vehicle, *spawn.alley, world.name, alleys.size(),
                    static_cast<int>(alleys.size()) - 1));
  }
  std::vector<Eigen::Vector3d> line = alleys[*spawn.alley].line_W;
  if (spawn.reverse) std::reverse(line.begin(), line.end());
  const Eigen::Vector2d first = line[0].head<2>();
  const Eigen::Vector2d along = (line[1].head<2>() - first).normalized();
  return {first - spawn.offset_m * along, std::atan2(along.y(), along.x())};
}

Heading find_point(const io::SpawnConfig& spawn, const WorldModel& world,
                   const std::string& vehicle) {
  std::vector<std::string> known;
  for (const SpawnPoint& point : world.spawn_points) {
    if (point.name == spawn.point) return {point.p_W, point.yaw_rad};
    known.push_back(point.name);
  }
  throw ConfigError(fmt::format(
      "{}: vehicles.{}.spawn.point = '{}', but world '{}' has no such spawn point{} (it has: {})",
      spawn.where.text(), vehicle, spawn.point, world.name, did_you_mean(spawn.point, known),
      known.empty() ? "none" : join(known)));
}

}  // namespace

Pose find_spawn_pose(const io::SpawnConfig& spawn, const WorldModel& world, const SceneQuery& scene,
                     const std::string& vehicle, double height_above_ground_m) {
  Heading heading{Eigen::Vector2d::Zero(), spawn.yaw_rad};
  if (spawn.alley) {
    heading = find_on_alley(spawn, world, vehicle);
  } else if (!spawn.point.empty()) {
    heading = find_point(spawn, world, vehicle);
  } else if (spawn.p_W) {
    heading.p_W = *spawn.p_W;
  }
  const double x = heading.p_W.x(), y = heading.p_W.y();
  constexpr double kFromAbove_m = 1e5;
  const auto ground = scene.ground_height_m(x, y, kFromAbove_m);
  if (!ground) {
    throw ConfigError(fmt::format(
        "{}: vehicles.{}.spawn is at x = {:.3f} m, y = {:.3f} m, where world '{}' has no ground",
        spawn.where.text(), vehicle, x, y, world.name));
  }
  // Slope from the ground a wheel base around, so that a pebble under the centre does not tilt the
  // vehicle.
  constexpr double kReach_m = 0.5;
  const auto height_at = [&](double dx, double dy) {
    return scene.ground_height_m(x + dx, y + dy, kFromAbove_m).value_or(*ground);
  };
  const Eigen::Vector3d normal(-(height_at(kReach_m, 0) - height_at(-kReach_m, 0)) / (2 * kReach_m),
                               -(height_at(0, kReach_m) - height_at(0, -kReach_m)) / (2 * kReach_m),
                               1.0);
  Pose pose;
  pose.q = quaternion_on_slope(heading.yaw_rad, normal);
  pose.p = Eigen::Vector3d(x, y, *ground) + height_above_ground_m * normal.normalized();
  return pose;
}

}  // namespace vinerow
