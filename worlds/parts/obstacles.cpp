#include "worlds/parts/obstacles.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "engine/api/height_field.h"
#include "engine/api/map.h"
#include "engine/api/parameter_table.h"
#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/io/meshes/mesh_file.h"
#include "worlds/mapping/model/row_curve.h"
#include "worlds/parts/crate.h"
#include "worlds/parts/label_choices.h"

namespace vinerow::worlds {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMaxObstacle_m = 100.0;  ///< longest side: a building's

struct Place {
  Vector2d p_W;
  double yaw_rad;
};

Place place_of(const ObstacleParams& obstacle, const std::string& who, const RowMap& map) {
  const bool free = obstacle.x_m || obstacle.y_m;
  const bool in_alley = obstacle.alley.has_value();
  if (free == in_alley) {
    throw ConfigError(fmt::format("{} {}, must be given x_m and y_m, or alley and distance_m", who,
                                  free ? "has both x_m, y_m and alley" : "has no position"));
  }
  if (free) {
    if (!obstacle.x_m || !obstacle.y_m) {
      throw ConfigError(fmt::format("{} has {} without {}", who, obstacle.x_m ? "x_m" : "y_m",
                                    obstacle.x_m ? "y_m" : "x_m"));
    }
    return {{*obstacle.x_m, *obstacle.y_m}, obstacle.yaw_rad};
  }
  const std::int64_t alley = *obstacle.alley;
  const auto count = static_cast<std::int64_t>(map.alleys.size());
  if (alley >= count) {
    throw ConfigError(
        fmt::format("{} is in alley {}, the world has {}", who, alley,
                    count == 0 ? "none" : fmt::format("{} alleys (0 to {})", count, count - 1)));
  }
  const mapping::RowCurve curve(from_above(map.alleys[static_cast<std::size_t>(alley)].line_W));
  const double s_m = obstacle.distance_m;
  const Vector2d along = curve.direction_W(s_m);
  return {curve.point_W(s_m) + obstacle.lateral_m * Vector2d(-along.y(), along.x()),
          std::atan2(along.y(), along.x()) + obstacle.yaw_rad};
}

/// Corners of the plan, counter-clockwise.
std::vector<Vector2d> plan_of(const Place& place, const Vector3d& size_m) {
  const Vector2d x = 0.5 * size_m.x() * Vector2d(std::cos(place.yaw_rad), std::sin(place.yaw_rad));
  const Vector2d y = 0.5 * size_m.y() * Vector2d(-std::sin(place.yaw_rad), std::cos(place.yaw_rad));
  return {place.p_W - x - y, place.p_W + x - y, place.p_W + x + y, place.p_W - x + y};
}

/// Stands on the plane through the ground under the corners. @param foot_m  set to how far the box
/// must reach below that plane to leave no gap
Pose pose_on_ground(const Place& place, const std::vector<Vector2d>& plan,
                    const HeightField& ground, double* foot_m) {
  Vector3d corners[4];
  for (int k = 0; k < 4; ++k) {
    const Vector2d& p = plan[static_cast<std::size_t>(k)];
    corners[k] = {p.x(), p.y(), ground.height_m(p.x(), p.y())};
  }
  // The diagonals span the plane that fits four corners of a rectangle best.
  const Vector3d normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalized();
  // The length keeps its heading seen from above, and rises with the plane.
  const double c = std::cos(place.yaw_rad), s = std::sin(place.yaw_rad);
  Eigen::Matrix3d R;
  R.col(0) = Vector3d(c, s, -(normal.x() * c + normal.y() * s) / normal.z()).normalized();
  R.col(1) = normal.cross(R.col(0));
  R.col(2) = normal;
  Pose X_WO;
  X_WO.q = Eigen::Quaterniond(R).normalized();
  X_WO.p = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  constexpr double kBuried_m = 0.02;
  const double twist_m = std::abs(normal.dot(corners[0] - X_WO.p));
  *foot_m = kBuried_m + twist_m;
  return X_WO;
}

const ParameterTable<ObstacleParams>& obstacle_table() {
  using P = ObstacleParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("name", &P::name, "name of the obstacle; default: its number in the list")
          .number("x_m", "m", &P::x_m, between(-1e5, 1e5), "position east; or give alley")
          .number("y_m", "m", &P::y_m, between(-1e5, 1e5), "position north; or give alley")
          .integer("alley", &P::alley, between(0, 10000), "alley of the obstacle")
          .number("distance_m", "m", &P::distance_m, between(-1e4, 1e5),
                  "distance along the alley's centre line from its first point")
          .number("lateral_m", "m", &P::lateral_m, between(-100.0, 100.0),
                  "offset to the left of the alley's centre line")
          .degrees("yaw_deg", &P::yaw_rad, between(-360.0, 360.0),
                   "direction of the length, from east; in an alley from the alley's direction")
          .numbers("size_m", "m", &P::size_m, between(0.02, kMaxObstacle_m),
                   "length, width, height of the box; absent: 0.6, 0.4, 0.6 m, or the file's")
          .path("file", &P::file,
                "mesh in place of a crate, standing on its z = 0: OBJ, STL, DAE, glTF, GLB or PLY")
          .choice("label", &P::label, kLabelChoices, "what cameras call it; absent: obstacle")
          .boolean("mapped", &P::mapped,
                   "true: it is in the occupancy grid (an occupancy_file is unchanged)");
  return table;
}

/// A box with its drawing.
struct Standing {
  Pose X_WO;
  Vector3d size_m;
  double foot_m = 0.0;
  std::vector<Vector2d> plan;
};

Standing stand_box(const Place& place, const Vector3d& size_m, const HeightField& ground) {
  Standing box;
  box.size_m = size_m;
  box.plan = plan_of(place, size_m);
  box.X_WO = pose_on_ground(place, box.plan, ground, &box.foot_m);
  return box;
}

/// People and plants stand upright also on slopes. The box reaches down to the lowest corner.
Standing stand_mesh(const Place& place, const Eigen::AlignedBox3d& bounds,
                    const HeightField& ground, Pose* X_WM) {
  *X_WM = {quaternion_from_rpy({0.0, 0.0, place.yaw_rad}),
           {place.p_W.x(), place.p_W.y(), ground.height_m(place.p_W.x(), place.p_W.y())}};
  Standing box;
  constexpr double kThinnest_m = 0.02;
  box.size_m = bounds.sizes().cwiseMax(kThinnest_m);
  box.size_m.z() = std::max(bounds.max().z(), kThinnest_m);
  box.X_WO =
      *X_WM * Pose{Eigen::Quaterniond::Identity(), {bounds.center().x(), bounds.center().y(), 0.0}};
  box.plan = plan_of({box.X_WO.p.head<2>(), place.yaw_rad}, box.size_m);
  for (const Vector2d& corner : box.plan) {
    const double below_m = box.X_WO.p.z() - ground.height_m(corner.x(), corner.y());
    box.foot_m = std::max(box.foot_m, below_m + kThinnest_m);
  }
  return box;
}

void add_meshes(const std::string& name, const io::MeshFile& file, const Pose& X_WM,
                std::optional<Label> label, WorldModel& world) {
  for (std::size_t i = 0; i < file.parts.size(); ++i) {
    MeshInstance instance;
    instance.name = file.parts.size() == 1 ? name : fmt::format("{}/{}", name, i);
    instance.mesh = file.parts[i].mesh;
    instance.X_WM = X_WM;
    instance.surface = SurfaceClass::kObstacle;
    instance.material = file.parts[i].material;
    instance.collides = false;
    instance.label = label;
    world.meshes.push_back(std::move(instance));
  }
}

}  // namespace

const ParameterTable<ObstaclesParams>& obstacles_table() {
  using P = ObstaclesParams;
  static const ParameterTable<P> table =
      ParameterTable<P>().groups("obstacles", &P::list, obstacle_table(),
                                 "boxes and meshes on the ground that vehicles must not touch");
  return table;
}

std::vector<std::vector<Vector2d>> place_obstacles(const ObstaclesParams& params,
                                                   WorldModel& world) {
  std::vector<std::vector<Vector2d>> mapped;
  std::set<std::string> names;
  for (std::size_t i = 0; i < params.list.size(); ++i) {
    VINEROW_DEMAND(world.terrain.has_value());
    const ObstacleParams& obstacle = params.list[i];
    const std::string name = obstacle.name.empty() ? fmt::format("{}", i) : obstacle.name;
    const std::string who = fmt::format("obstacles: '{}'", name);
    if (!names.insert(name).second) throw ConfigError(who + " is in the list twice");

    const Place place = place_of(obstacle, who, world.rows);
    if (!world.terrain->contains(place.p_W.x(), place.p_W.y())) {
      throw ConfigError(fmt::format("{} is at ({:.2f}, {:.2f}) m, outside the terrain", who,
                                    place.p_W.x(), place.p_W.y()));
    }
    std::optional<io::MeshFile> file;
    Standing standing;
    Pose X_WM;
    if (obstacle.file.empty()) {
      constexpr double kCrate_m[] = {0.6, 0.4, 0.6};
      standing = stand_box(place, obstacle.size_m.value_or(Vector3d(kCrate_m)), *world.terrain);
    } else {
      if (obstacle.size_m) {
        throw ConfigError(who + " has both size_m and file: a mesh has its own size");
      }
      file = io::load_mesh(obstacle.file);
      for (const std::string& note : file->notes) world.notes.push_back(note);
      const std::string doubt =
          io::doubt_unit(obstacle.file, file->bounds(), Vector3d::Constant(kMaxObstacle_m),
                         "scale it by 0.001 before");
      if (!doubt.empty()) world.notes.push_back(doubt);
      standing = stand_mesh(place, file->bounds(), *world.terrain, &X_WM);
    }

    MeshInstance box;
    box.name = "obstacle/" + name;
    box.mesh = std::make_shared<TriangleMesh>(make_box(standing.size_m, standing.foot_m));
    box.X_WM = standing.X_WO;
    box.surface = SurfaceClass::kObstacle;
    box.visible = false;
    world.meshes.push_back(box);

    if (file) {
      add_meshes("object/" + name, *file, X_WM, obstacle.label, world);
    } else {
      MeshInstance crate = box;
      crate.name = "crate/" + name;
      crate.mesh = std::make_shared<TriangleMesh>(make_crate(standing.size_m, standing.foot_m));
      crate.material = {"crate", {1.0f, 1.0f, 1.0f}, 0.85f, "builtin:wood", false};
      crate.collides = false;
      crate.visible = true;
      crate.label = obstacle.label;
      world.meshes.push_back(std::move(crate));
    }
    if (obstacle.mapped) mapped.push_back(standing.plan);
  }
  return mapped;
}

}  // namespace vinerow::worlds
