#pragma once
/// A vehicle with two steered axles on a flat course: pure rolling about the instantaneous centre,
/// rate-limited steering and speed, ultrasonic readings by ray casting against true obstacles, and
/// guidance `dwa` in a loop (loop.h).

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "controllers/parts/paths/path_curve.h"
#include "engine/api/map.h"
#include "tests/controllers/support/loop.h"

namespace vinerow::test {

using Polygon = std::vector<Eigen::Vector2d>;

Polygon make_box(double x_low, double x_high, double y_low, double y_high);
/// Corners of a polygon of B at a pose.
Polygon place(const Polygon& polygon_B, const controllers::Pose2& pose);
/// Distance between convex polygons, 0 where they overlap: edges against corners, and separation by
/// every edge's normal. Shares nothing with the code under test.
double distance_between(const Polygon& a, const Polygon& b);

/// The rover of paper A: 1.5 x 1.0 m hull with wheel noses, axles 0.75 m from the centre, 23 deg.
VehicleDescription make_four_wheel_rover();

/// Four rangers, two ahead and one to each side, with a cone of +-15 deg.
std::vector<SensorMounting> make_rangers();

struct Course {
  std::vector<Polygon> known;    ///< on the map
  std::vector<Polygon> unknown;  ///< true obstacles that the map does not have
  Eigen::AlignedBox2d grid{Eigen::Vector2d(-3, -1.6), Eigen::Vector2d(33, 1.6)};
  double cell_m = 0.05;
  PlannedPath plan;
  controllers::Pose2 start;
  Values values;  ///< of the guidance
  double longest_s = 120.0;
  double range_noise_m = 0.0;
  std::vector<SensorMounting> sensors = make_rangers();
  /// Obstacles that go away at this time.
  double unknown_until_s = 1e9;
  /// Where the movement authority ends at a time, along the plan; default: there is none.
  std::function<double(double time_s)> stop_at_m;
};

/// Alley of 2.5 m along x from 0 to 30 m between two canopies; the plan is its centre line.
Course make_alley(double canopy_half_m = 0.3);
/// A polyline with headings and curvature as planners write it: straight pieces and arcs.
/// @param pieces  (length m, curvature 1/m) one after the other
PlannedPath make_plan(const controllers::Pose2& start,
                      const std::vector<std::pair<double, double>>& pieces, double pitch_m = 0.25);
RowMap make_map(const Course& course);

struct Drive {
  bool finished = false;
  double time_s = 0.0;
  double min_known_m = 1e9;    ///< true distance of the outline, polygons
  double min_unknown_m = 1e9;  ///< the same to what the map does not have
  double farthest_off_plan_m = 0.0;
  int reversals = 0;  ///< times the vehicle began to go backwards
  int drive_ticks = 0, follow_ticks = 0, stop_ticks = 0;
  std::size_t allocations = 0;  ///< in steps without an event, except the first step
  std::vector<LoopEvent> events;
  std::vector<controllers::Pose2> poses;  ///< 10 Hz
  std::vector<LocalCommand> commands;     ///< 10 Hz
  controllers::Pose2 end;
};

/// Until the end of the plan or longest_s.
Drive drive(const Course& course);

}  // namespace vinerow::test
