#include "engine/sim/spawn.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"
#include "engine/api/vehicle.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/math/angles.h"
#include "engine/physics/box_distance.h"
#include "engine/physics/mesh_distance.h"
#include "engine/physics/winding.h"
#include "engine/sim/placement_ground.h"

namespace vinerow {
namespace {

struct Heading {
  Eigen::Vector2d p_W;
  double yaw_rad;
};

Heading find_on_alley(const scenario::SpawnConfig& spawn, const WorldModel& world,
                      const std::string& vehicle) {
  const auto& alleys = world.rows->alleys;
  if (alleys.empty()) {
    throw ConfigError(
        fmt::format("{}: vehicles.{}.spawn.alley = {}, but world '{}' has {} row{} and so no alley "
                    "between two: add rows, or set the vehicle's spawn to {{x_m, y_m}}",
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
  const Eigen::Vector2d left(-along.y(), along.x());
  return {first - spawn.offset_m * along + spawn.lateral_m * left,
          std::atan2(along.y(), along.x()) + spawn.turn_rad};
}

Heading find_point(const scenario::SpawnConfig& spawn, const WorldModel& world,
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

/// Distance at which the ground is sampled for the slope. Chosen: about half a wheel base, so that
/// a pebble under the centre does not tilt the vehicle.
constexpr double kReach_m = 0.5;

/// Slope of the ground along an axis; from one side alone if there is no ground on the other.
double calc_slope(double here_m, std::optional<double> ahead_m, std::optional<double> behind_m) {
  if (ahead_m && behind_m) return (*ahead_m - *behind_m) / (2 * kReach_m);
  if (ahead_m) return (*ahead_m - here_m) / kReach_m;
  if (behind_m) return (here_m - *behind_m) / kReach_m;
  return 0.0;
}

/// First mesh of the classes in `mask` that a box touches. Slow; used only for an error message.
const MeshInstance* find_touched(const WorldModel& world, const StartBox& box, SurfaceMask mask) {
  for (const MeshInstance& instance : world.meshes) {
    if ((mask & mask_of(instance.surface)) == 0) continue;
    WorldModel alone;
    alone.meshes.push_back(instance);
    if (physics::MeshDistance(alone).to_box_m(box.X_WC, box.half_m, 1.0, mask) == 0.0) {
      return &instance;
    }
  }
  return nullptr;
}

/// Mesh of the classes in `mask` that contains a point: a ray upwards leaves it. Half a closed mesh
/// contains nothing: a vehicle may stand in a barn whose door is open.
const MeshInstance* find_around(const WorldModel& world, const SceneQuery& scene,
                                const Eigen::Vector3d& p_W, SurfaceMask mask) {
  constexpr double kClosed = 0.999, kHigh_m = 1000.0, kPast_m = 1e-6;
  const Eigen::Vector3d up_W = Eigen::Vector3d::UnitZ();
  double from_m = 0.0;
  while (const auto hit = scene.cast_ray(p_W + from_m * up_W, up_W, kHigh_m - from_m, mask)) {
    from_m += hit->distance_m + kPast_m;
    if (from_m >= kHigh_m) break;
    const MeshInstance& instance = world.meshes[static_cast<std::size_t>(hit->mesh)];
    const Eigen::Vector3d p_M = instance.X_WM.inverse() * p_W;
    if (std::abs(physics::calc_winding(*instance.mesh, p_M)) > kClosed) return &instance;
  }
  return nullptr;
}

/// Hint on free places of the world, for the end of an error message.
std::string name_free_places(const WorldModel& world) {
  if (!world.rows->alleys.empty()) {
    return fmt::format("; 'alley: 0' to 'alley: {}' start in the middle of an alley",
                       world.rows->alleys.size() - 1);
  }
  return "; move it";
}

}  // namespace

std::string larger_ground_hint(const ParameterSet& world) {
  constexpr const char* kSurroundings = "surroundings_m";
  for (const ParameterSpec& spec : world.specs()) {
    if (spec.name != kSurroundings) continue;
    return fmt::format("; increase world.{} ({:g} m now) to extend it", kSurroundings,
                       world.number(kSurroundings));
  }
  return "; keep it on the ground, or extend the ground of the world";
}

Pose find_spawn_pose(const scenario::SpawnConfig& spawn, const WorldModel& world,
                     const SceneQuery& scene, const std::string& vehicle,
                     double height_above_ground_m, const std::string& remedy) {
  Heading heading{Eigen::Vector2d::Zero(), spawn.yaw_rad};
  if (spawn.alley) {
    heading = find_on_alley(spawn, world, vehicle);
  } else if (!spawn.point.empty()) {
    heading = find_point(spawn, world, vehicle);
  } else if (spawn.p_W) {
    heading.p_W = *spawn.p_W;
  }
  const double x = heading.p_W.x(), y = heading.p_W.y();
  const PlacementGround surface(world, scene);
  const auto ground = surface.height_m(x, y);
  if (!ground) {
    throw ConfigError(fmt::format(
        "{}: vehicles.{}.spawn is at x = {:.3f} m, y = {:.3f} m, where world '{}' has no ground{}",
        spawn.where.text(), vehicle, x, y, world.name, remedy));
  }
  const bool obstacles = surface.takes_obstacles(x, y);
  const auto height_at = [&](double dx, double dy) {
    return surface.height_near_m(x + dx, y + dy, *ground, obstacles, kReach_m);
  };
  const Eigen::Vector3d normal(
      -calc_slope(*ground, height_at(kReach_m, 0), height_at(-kReach_m, 0)),
      -calc_slope(*ground, height_at(0, kReach_m), height_at(0, -kReach_m)), 1.0);
  Pose pose;
  pose.q = quaternion_on_slope(heading.yaw_rad, normal);
  pose.p = Eigen::Vector3d(x, y, *ground) + height_above_ground_m * normal.normalized();
  return pose;
}

StartBox find_start_box(const std::string& vehicle, const Pose& X_WB,
                        const VehicleDescription& description) {
  const Eigen::Vector3d half = description.collision_half_extents_m;
  Eigen::AlignedBox3d box(description.collision_centre_B - half,
                          description.collision_centre_B + half);
  for (const Eigen::Vector2d& p : description.footprint_B) {
    box.extend(Eigen::Vector3d(p.x(), p.y(), description.collision_centre_B.z()));
  }
  if (description.wheeled) {
    // Tolerance for a wheel on a pebble.
    constexpr double kPebble_m = 0.05;
    box.extend(Eigen::Vector3d(box.center().x(), box.center().y(),
                               kPebble_m - description.height_above_ground_m));
  }
  return {vehicle, {X_WB.q, X_WB * box.center()}, 0.5 * box.sizes()};
}

void refuse_start_in_contact(const scenario::SpawnConfig& spawn, const StartBox& box,
                             const std::vector<StartBox>& others, const WorldModel& world,
                             const SceneQuery& scene) {
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    throw ConfigError(fmt::format(
        "{}: vehicles.{}.spawn: at x = {:.3f} m, y = {:.3f} m the vehicle would stand in {}{}",
        spawn.where.text(), box.vehicle, box.X_WC.p.x(), box.X_WC.p.y(), what, remedy));
  };
  // Vehicles side by side may touch.
  constexpr double kTouch_m = 1e-3;
  const Eigen::Vector3d inner_m = (box.half_m.array() - kTouch_m).max(0.0);
  for (const StartBox& other : others) {
    if (physics::box_distance_m(box.X_WC, inner_m, other.X_WC, other.half_m) > 0.0) continue;
    refuse(fmt::format("vehicle '{}', which starts at x = {:.3f} m, y = {:.3f} m", other.vehicle,
                       other.X_WC.p.x(), other.X_WC.p.y()),
           "; move one of them");
  }
  const bool on_obstacles =
      PlacementGround(world, scene).takes_obstacles(box.X_WC.p.x(), box.X_WC.p.y());
  // The ground may touch the lower 55 % of the box, so only the upper 45 % is checked against it.
  StartBox upper = box;
  upper.X_WC.p = box.X_WC * Eigen::Vector3d(0.0, 0.0, 0.55 * box.half_m.z());
  upper.half_m.z() *= 0.45;
  constexpr double kSearch_m = 1.0;
  for (const SurfaceClass surface :
       {SurfaceClass::kCanopy, SurfaceClass::kPost, SurfaceClass::kTrunk, SurfaceClass::kObstacle,
        SurfaceClass::kTerrain}) {
    const bool is_ground =
        surface == SurfaceClass::kTerrain || (surface == SurfaceClass::kObstacle && on_obstacles);
    const StartBox& clearance_box = is_ground ? upper : box;
    const SurfaceMask mask = mask_of(surface);
    if (scene.distance_to_box_m(clearance_box.X_WC, clearance_box.half_m, kSearch_m, mask) > 0.0)
      continue;
    const MeshInstance* touched = find_touched(world, clearance_box, mask);
    const bool is_deck = surface == SurfaceClass::kObstacle;
    refuse(touched ? fmt::format("the {} '{}'", to_string(surface), touched->name) : "the ground",
           (spawn.alley ? "; change its offset_m" : name_free_places(world)) +
               (is_deck ? " (ground on which vehicles start must be of surface terrain)" : ""));
  }
  // Distances are to surfaces.
  constexpr SurfaceMask kSolid = mask_of(SurfaceClass::kCanopy) | mask_of(SurfaceClass::kPost) |
                                 mask_of(SurfaceClass::kTrunk) | mask_of(SurfaceClass::kObstacle);
  if (const MeshInstance* around = find_around(world, scene, box.X_WC.p, kSolid)) {
    refuse(fmt::format("the {} '{}'", to_string(around->surface), around->name),
           spawn.alley ? "; change its offset_m" : name_free_places(world));
  }
}

}  // namespace vinerow
