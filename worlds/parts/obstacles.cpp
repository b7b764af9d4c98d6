#include "worlds/parts/obstacles.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "engine/api/height_field.h"
#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "worlds/parts/crate.h"
#include "worlds/parts/row_curve.h"

namespace vinerow::worlds {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Place {
  Vector2d p_W;
  double yaw_rad;
};

Place place_of(const ParameterSet& obstacle, const std::string& who, const RowMap& map) {
  const bool free = obstacle.has("x_m") || obstacle.has("y_m");
  const bool in_alley = obstacle.has("alley");
  const double yaw_rad = rad_from_deg(obstacle.number("yaw_deg"));
  if (free == in_alley) {
    throw ConfigError(fmt::format("{} {}, must be given x_m and y_m, or alley and distance_m", who,
                                  free ? "has both x_m, y_m and alley" : "has no position"));
  }
  if (free) {
    if (!obstacle.has("x_m") || !obstacle.has("y_m")) {
      throw ConfigError(fmt::format("{} has {} without {}", who,
                                    obstacle.has("x_m") ? "x_m" : "y_m",
                                    obstacle.has("x_m") ? "y_m" : "x_m"));
    }
    return {{obstacle.number("x_m"), obstacle.number("y_m")}, yaw_rad};
  }
  const std::int64_t alley = obstacle.integer("alley");
  const auto count = static_cast<std::int64_t>(map.alleys.size());
  if (alley >= count) {
    throw ConfigError(
        fmt::format("{} stands in alley {}, the world has {}", who, alley,
                    count == 0 ? "none" : fmt::format("{} alleys (0 to {})", count, count - 1)));
  }
  std::vector<Vector2d> line;
  for (const Vector3d& p : map.alleys[static_cast<std::size_t>(alley)].line_W) {
    line.push_back(p.head<2>());
  }
  const RowCurve curve(std::move(line));
  const double s_m = obstacle.number("distance_m");
  const Vector2d along = curve.direction_W(s_m);
  return {curve.point_W(s_m) + obstacle.number("lateral_m") * Vector2d(-along.y(), along.x()),
          std::atan2(along.y(), along.x()) + yaw_rad};
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

}  // namespace

std::vector<ParameterSpec> obstacle_parameters() {
  ParameterSpec size =
      number_list_parameter("size_m", "m", {0.6, 0.4, 0.6}, "length, width, height of the box", 3);
  size.min = 0.02;
  size.max = 100.0;
  return {group_list_parameter(
      "obstacles",
      {text_parameter("name", "", "name of the obstacle; default: its number in the list"),
       optional(number_parameter("x_m", "m", 0, -1e5, 1e5, "position east; or give alley")),
       optional(number_parameter("y_m", "m", 0, -1e5, 1e5, "position north; or give alley")),
       optional(integer_parameter("alley", 0, 0, 10000, "stands in this alley")),
       number_parameter("distance_m", "m", 0, -1e4, 1e5,
                        "along the alley's centre line from its first point"),
       number_parameter("lateral_m", "m", 0, -100, 100, "to the left of the alley's centre line"),
       number_parameter("yaw_deg", "deg", 0, -360, 360,
                        "of the length: from east, in an alley from the alley's direction"),
       size,
       boolean_parameter("mapped", false,
                         "whether the occupancy grid has it (an occupancy_file stays as it is)")},
      "boxes on the ground that vehicles must not touch")};
}

std::vector<std::vector<Vector2d>> place_obstacles(const ParameterSet& parameters,
                                                   WorldModel& world) {
  std::vector<std::vector<Vector2d>> mapped;
  std::set<std::string> names;
  const std::vector<ParameterSet>& obstacles = parameters.groups("obstacles");
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    VINEROW_DEMAND(world.terrain.has_value());
    const ParameterSet& obstacle = obstacles[i];
    const std::string& given = obstacle.text("name");
    const std::string name = given.empty() ? fmt::format("{}", i) : given;
    const std::string who = fmt::format("obstacle '{}'", name);
    if (!names.insert(name).second) throw ConfigError(who + " stands twice in the list");

    const Place place = place_of(obstacle, who, world.rows);
    if (!world.terrain->contains(place.p_W.x(), place.p_W.y())) {
      throw ConfigError(fmt::format("{} stands at ({:.2f}, {:.2f}) m, outside the terrain", who,
                                    place.p_W.x(), place.p_W.y()));
    }
    const std::vector<double>& size = obstacle.numbers("size_m");
    const Vector3d size_m(size[0], size[1], size[2]);
    const std::vector<Vector2d> plan = plan_of(place, size_m);
    double foot_m = 0.0;
    const Pose X_WO = pose_on_ground(place, plan, *world.terrain, &foot_m);

    MeshInstance box;
    box.name = "obstacle/" + name;
    box.mesh = std::make_shared<TriangleMesh>(make_box(size_m, foot_m));
    box.X_WM = X_WO;
    box.surface = SurfaceClass::kObstacle;
    box.visible = false;
    world.meshes.push_back(box);

    MeshInstance crate = box;
    crate.name = "crate/" + name;
    crate.mesh = std::make_shared<TriangleMesh>(make_crate(size_m, foot_m));
    crate.material = {"crate", {1.0f, 1.0f, 1.0f}, 0.85f, "builtin:wood", false};
    crate.collides = false;
    crate.visible = true;
    world.meshes.push_back(std::move(crate));
    if (obstacle.boolean("mapped")) mapped.push_back(plan);
  }
  return mapped;
}

}  // namespace vinerow::worlds
