#include "tests/controllers/dwa/course.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/messages/sensors.h"
#include "engine/api/world_model.h"
#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test {
namespace {

constexpr double kHalfAngle_rad = 15.0 * kPi / 180.0;
constexpr double kStep_s = 0.01;
constexpr double kAcceleration_mps2 = 0.5;
constexpr double kSteerRate_radps = 2.0;

double point_to_edge(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - (a + t * (b - a))).norm();
}

/// True where the line along an edge of `a` has all of `b` on its outer side.
bool has_separating_edge(const Polygon& a, const Polygon& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector2d along = a[(i + 1) % a.size()] - a[i];
    const Eigen::Vector2d out(along.y(), -along.x());
    if (std::all_of(b.begin(), b.end(),
                    [&](const Eigen::Vector2d& p) { return out.dot(p - a[i]) > 0.0; })) {
      return true;
    }
  }
  return false;
}

double min_distance(const Polygon& outline, const std::vector<Polygon>& obstacles) {
  double min_m = 1e9;
  for (const Polygon& obstacle : obstacles) {
    min_m = std::min(min_m, distance_between(outline, obstacle));
  }
  return min_m;
}

/// Where a ray meets an edge, or infinity.
double cast(const Eigen::Vector2d& p, const Eigen::Vector2d& to, const Polygon& polygon) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i], e = polygon[(i + 1) % polygon.size()] - a;
    const double det = cross(to, e);
    if (std::abs(det) < 1e-12) continue;
    const double range = cross(a - p, e) / det, share = cross(a - p, to) / det;
    if (range > 0.0 && share >= 0.0 && share <= 1.0) nearest = std::min(nearest, range);
  }
  return nearest;
}

RangeSample measure(const Pose& X_WS, const Course& course, bool with_unknown) {
  RangeSample sample;
  sample.range_m = std::numeric_limits<double>::infinity();
  sample.min_range_m = 0.02;
  sample.max_range_m = 4.0;
  sample.half_angle_rad = kHalfAngle_rad;
  // Nobody may look at the truth: a pose that would lead astray.
  sample.X_WS.p = {1e3, 1e3, 0};
  const double yaw = yaw_from_quaternion(X_WS.q);
  for (int i = -20; i <= 20; ++i) {
    const Eigen::Vector2d to = controllers::direction(yaw + kHalfAngle_rad * i / 20.0);
    for (const Polygon& p : course.known) {
      sample.range_m = std::min(sample.range_m, cast(X_WS.p.head<2>(), to, p));
    }
    for (const Polygon& p : course.unknown) {
      if (with_unknown) sample.range_m = std::min(sample.range_m, cast(X_WS.p.head<2>(), to, p));
    }
  }
  if (sample.range_m > sample.max_range_m) {
    sample.range_m = std::numeric_limits<double>::infinity();
  }
  return sample;
}

/// The vehicle: exact rolling while it drives itself, along the plan while it follows.
struct Roller {
  controllers::Pose2 pose;
  double v_mps = 0.0, front_rad = 0.0, rear_rad = 0.0;
  double s_m = 0.0, lateral_m = 0.0, heading_rad = 0.0;  // while following
  bool is_following = false;

  Odometry truth() const {
    Odometry odometry;
    odometry.X_WB = {quaternion_from_rpy({0, 0, pose.yaw_rad}), {pose.p.x(), pose.p.y(), 0.0}};
    const double course_rad = std::atan(0.5 * (std::tan(front_rad) + std::tan(rear_rad)));
    odometry.v_WB_B.head<2>() = v_mps * controllers::direction(course_rad);
    return odometry;
  }

  void step(const LocalCommand& command, const controllers::Path& path) {
    const double wanted = command.mode == LocalCommand::Mode::kStop ? 0.0 : command.v_mps;
    v_mps +=
        std::clamp(wanted - v_mps, -kAcceleration_mps2 * kStep_s, kAcceleration_mps2 * kStep_s);
    if (command.mode == LocalCommand::Mode::kFollow && v_mps >= 0.0) {
      follow(path);
      return;
    }
    is_following = false;
    const double max_step_rad = kSteerRate_radps * kStep_s;
    if (command.mode == LocalCommand::Mode::kDrive) {
      front_rad += std::clamp(command.front_axle_rad - front_rad, -max_step_rad, max_step_rad);
      rear_rad += std::clamp(command.rear_axle_rad - rear_rad, -max_step_rad, max_step_rad);
    }
    // Rolling about the instantaneous centre: the axles' velocities point along their wheels.
    const double k = (std::tan(front_rad) - std::tan(rear_rad)) / 1.5;
    const double s = 0.5 * (std::tan(front_rad) + std::tan(rear_rad));
    const double v_x = v_mps / std::hypot(1.0, s), yaw_rate = k * v_x;
    const double turned = yaw_rate * kStep_s;
    // Exact integral of the constant twist (v_x, s v_x, yaw_rate).
    const double sinc = std::abs(turned) < 1e-9 ? 1.0 : std::sin(turned) / turned;
    const double cosc = std::abs(turned) < 1e-9 ? 0.5 * turned : (1.0 - std::cos(turned)) / turned;
    const Eigen::Vector2d v_B(v_x, s * v_x);
    const Eigen::Vector2d moved_B =
        kStep_s * Eigen::Vector2d(sinc * v_B.x() - cosc * v_B.y(), cosc * v_B.x() + sinc * v_B.y());
    pose.p += Eigen::Rotation2Dd(pose.yaw_rad) * moved_B;
    pose.yaw_rad += turned;
  }

  /// A tracking controller: what error there is dies out over 1.5 m.
  void follow(const controllers::Path& path) {
    if (!is_following) {
      const double from = std::max(s_m - 2.0, 0.0);
      const controllers::Path::Nearest at = path.nearest(pose.p, from, s_m + 2.0);
      s_m = at.distance_m;
      lateral_m = at.lateral_error_m;
      heading_rad = wrap_angle(pose.yaw_rad - at.yaw_rad);
      is_following = true;
    }
    const double ds = v_mps * kStep_s;
    s_m += ds;
    lateral_m *= std::exp(-ds / 1.5);
    heading_rad *= std::exp(-ds / 1.5);
    const controllers::Pose2 on = path.pose_at(s_m);
    pose = {on.p + lateral_m * left_of(controllers::direction(on.yaw_rad)),
            on.yaw_rad + heading_rad};
    front_rad = std::atan(0.75 * path.curvature_at(s_m));
    rear_rad = -front_rad;
  }
};

}  // namespace

Polygon make_box(double x_low, double x_high, double y_low, double y_high) {
  return {{x_low, y_low}, {x_high, y_low}, {x_high, y_high}, {x_low, y_high}};
}

Polygon place(const Polygon& polygon_B, const controllers::Pose2& pose) {
  Polygon placed;
  for (const Eigen::Vector2d& p : polygon_B) {
    placed.push_back(pose.p + Eigen::Rotation2Dd(pose.yaw_rad) * p);
  }
  return placed;
}

double distance_between(const Polygon& a, const Polygon& b) {
  if (!has_separating_edge(a, b) && !has_separating_edge(b, a)) return 0.0;
  double min_m = 1e9;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < b.size(); ++k) {
      min_m = std::min(min_m, point_to_edge(a[i], b[k], b[(k + 1) % b.size()]));
      min_m = std::min(min_m, point_to_edge(b[k], a[i], a[(i + 1) % a.size()]));
    }
  }
  return min_m;
}

VehicleDescription make_four_wheel_rover() {
  VehicleDescription description;
  description.type = "four_wheel_steering_rover";
  description.actuators = {{"axle_front_steer_rad", "rad", -0.4014, 0.4014},
                           {"axle_rear_steer_rad", "rad", -0.4014, 0.4014}};
  for (const char* wheel : {"fl", "fr", "rl", "rr"}) {
    description.actuators.push_back(
        {std::string("wheel_") + wheel + "_speed_radps", "rad/s", -8.0, 8.0});
  }
  description.footprint_B = {{-0.95, -0.36}, {-0.75, -0.5}, {0.75, -0.5}, {0.95, -0.36},
                             {0.95, 0.36},   {0.75, 0.5},   {-0.75, 0.5}, {-0.95, 0.36}};
  description.height_above_ground_m = 0.45;
  description.max_speed_mps = 1.6;
  description.min_turning_radius_m = 1.767;
  description.wheeled = {
      .track_m = 0.85, .wheel_base_m = 1.5, .wheel_radius_m = 0.2, .wheel_speed_limit_radps = 8.0};
  description.steered = {.front_axle_m = 0.75,
                         .rear_axle_m = 0.75,
                         .max_axle_steer_rad = 23.0 * kPi / 180.0,
                         .steer_rate_radps = 2.0};
  return description;
}

std::vector<SensorMounting> make_rangers() {
  const auto at = [](double x, double y, double yaw_rad) {
    return Pose{quaternion_from_rpy({0, 0, yaw_rad}), {x, y, 0.25}};
  };
  return {{"front_left", "ultrasound", at(0.95, 0.15, 0.0)},
          {"front_right", "ultrasound", at(0.95, -0.15, 0.0)},
          {"side_left", "ultrasound", at(0.6, 0.45, 0.5 * kPi)},
          {"side_right", "ultrasound", at(0.6, -0.45, -0.5 * kPi)}};
}

PlannedPath make_plan(const controllers::Pose2& start,
                      const std::vector<std::pair<double, double>>& pieces, double pitch_m) {
  PlannedPath plan;
  controllers::Pose2 pose = start;
  const auto add = [&](double curvature) {
    PathPoint point;
    point.p_W = {pose.p.x(), pose.p.y(), 0.0};
    point.yaw_rad = pose.yaw_rad;
    point.curvature_per_m = curvature;
    plan.points.push_back(point);
  };
  for (const auto& [length, curvature] : pieces) {
    const int parts = std::max(1, static_cast<int>(std::ceil(length / pitch_m)));
    for (int i = 0; i < parts; ++i) {
      add(curvature);
      pose = controllers::advance(pose, length / parts, length / parts * curvature);
    }
    plan.length_m += length;
  }
  add(0.0);
  return plan;
}

Course make_alley(double canopy_half_m) {
  Course course;
  course.known = {make_box(0, 30, 1.25 - canopy_half_m, 1.55),
                  make_box(0, 30, -1.55, -1.25 + canopy_half_m)};
  course.plan = make_plan({{0, 0}, 0}, {{28.0, 0.0}});
  return course;
}

RowMap make_map(const Course& course) {
  RowMap map;
  OccupancyGrid& grid = map.occupancy;
  grid.cell_m = course.cell_m;
  grid.corner_W = course.grid.min();
  grid.columns = static_cast<int>(std::lround(course.grid.sizes().x() / course.cell_m));
  grid.rows = static_cast<int>(std::lround(course.grid.sizes().y() / course.cell_m));
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const Eigen::Vector2d centre =
          grid.corner_W + course.cell_m * Eigen::Vector2d(i + 0.5, j + 0.5);
      bool occupied = false;
      for (const Polygon& polygon : course.known) {
        bool inside = true;
        for (std::size_t k = 0; k < polygon.size(); ++k) {
          const Eigen::Vector2d a = polygon[k], b = polygon[(k + 1) % polygon.size()];
          inside = inside && cross(b - a, centre - a) >= 0.0;
        }
        occupied = occupied || inside;
      }
      grid.cells.push_back(occupied ? 1 : 0);
    }
  }
  return map;
}

Drive drive(const Course& course) {
  const RowMap map = make_map(course);
  Loop loop({.description = make_four_wheel_rover(),
             .tick = Duration{100'000'000},
             .physics = Duration{10'000'000},
             .map = &map,
             .sensors = course.sensors});
  loop.add_guidance({"dwa", course.values});
  loop.set_stop_at(course.stop_at_m);
  loop.give_plan(course.plan);

  Drive result;
  const controllers::Path path(course.plan);
  Roller plant;
  plant.pose = course.start;
  RandomStream random(1, "rover", "ranges");
  bool with_unknown = true;
  const auto move = [&](double) {
    const double before = plant.v_mps;
    plant.step(loop.read<LocalCommand>("local_command"), path);
    if (plant.v_mps < 0.0 && before >= 0.0) ++result.reversals;
    const Polygon outline = place(loop.description().footprint_B, plant.pose);
    result.min_known_m = std::min(result.min_known_m, min_distance(outline, course.known));
    if (with_unknown) {
      result.min_unknown_m = std::min(result.min_unknown_m, min_distance(outline, course.unknown));
    }
  };
  loop.set_plant([&] { return plant.truth(); }, move);
  loop.set_inputs([&] {
    with_unknown = loop.time_s() < course.unknown_until_s;
    loop.write("encoders", NamedValues{{"axle_front_steer_rad", "axle_rear_steer_rad"},
                                       {plant.front_rad, plant.rear_rad}});
    for (const SensorMounting& sensor : course.sensors) {
      RangeSample sample = measure(plant.truth().X_WB * sensor.X_BS, course, with_unknown);
      sample.range_m += course.range_noise_m * random.normal();
      loop.write(sensor.name, sample);
    }
  });
  const int ticks = static_cast<int>(course.longest_s * 10.0);
  for (int tick = 0; tick < ticks && !result.finished; ++tick) {
    result.time_s = loop.time_s();
    loop.sense();
    const std::size_t events = loop.events().size();
    std::size_t allocations = 0;
    {
      AllocationCounter counter;
      loop.decide();
      allocations = counter.count();
    }
    if (tick > 0 && loop.events().size() == events) result.allocations += allocations;
    const LocalCommand& command = loop.read<LocalCommand>("local_command");
    result.commands.push_back(command);
    result.poses.push_back(plant.pose);
    result.drive_ticks += command.mode == LocalCommand::Mode::kDrive;
    result.follow_ticks += command.mode == LocalCommand::Mode::kFollow;
    result.stop_ticks += command.mode == LocalCommand::Mode::kStop;
    loop.move();
    const controllers::Path::Nearest at = path.nearest(plant.pose.p, 0.0, path.length_m());
    result.farthest_off_plan_m = std::max(result.farthest_off_plan_m, std::abs(at.lateral_error_m));
    if (!plant.is_following)
      plant.s_m =
          path.nearest(plant.pose.p, std::max(plant.s_m - 2.0, 0.0), plant.s_m + 2.0).distance_m;
    result.finished = plant.s_m > path.length_m() - 0.1;
  }
  result.events = loop.events();
  result.end = plant.pose;
  return result;
}

}  // namespace vinerow::test
