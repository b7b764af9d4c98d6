#pragma once
/// Messages about paths: a plan, how far it may be followed, and how a follower does on it.
/// Frames and units: engine/api/messages.h.

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace vinerow {

/// Straight pieces in W, two points each: a planner's tree. ROS 2: visualization_msgs/msg/Marker
/// (LINE_LIST).
struct LineList {
  static constexpr const char* kType = "LineList";
  std::vector<Eigen::Vector3d> points_W;  ///< an even number

  template <class F>
  void fields(F&& f) {
    for (Eigen::Vector3d& p : points_W) f(p);
  }
};

/// What a stretch of path is for. Metrics judge legs and turns apart.
enum class PathKind : std::uint8_t {
  kLeg = 0,
  kTurn = 1,
  kTransit = 2,
  kVertical = 3,  ///< straight up or down: a take-off, a landing
  kReturn = 4     ///< the way home after the last leg
};

/// One point of a path; the stretch from this point to the next has `kind`.
struct PathPoint {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;          ///< direction of travel
  double curvature_per_m = 0.0;  ///< of the stretch that starts here, positive to the left
  double speed_mps = 0.0;        ///< wanted speed; 0 = the follower's own
  PathKind kind = PathKind::kLeg;
  std::int32_t alley = -1;  ///< index of the alley a leg runs in, -1 elsewhere
};

/// What a follower is to drive. ROS 2: nav_msgs/msg/Path.
struct PlannedPath {
  static constexpr const char* kType = "PlannedPath";
  std::vector<PathPoint> points;
  double length_m = 0.0;  ///< of the exact curve, not of the polyline

  template <class F>
  void fields(F&& f) {
    for (PathPoint& point : points) {
      f(point.p_W), f(point.yaw_rad), f(point.curvature_per_m), f(point.speed_mps);
      f(point.kind), f(point.alley);
    }
    f(length_m);
  }
};

/// How far a vehicle may go along its plan: what whoever shares the alleys out grants it. Without
/// one it may go to the end. ROS 2: vinerow_msgs/msg/MovementAuthority.
struct MovementAuthority {
  static constexpr const char* kType = "MovementAuthority";
  double stop_at_m = 0.0;     ///< distance along the plan at which to stand still; +infinity: none
  std::int32_t alley = -1;    ///< waited for; -1: none
  std::string holder;         ///< vehicle that has it; "" where nobody is waited for

  template <class F>
  void fields(F&& f) {
    f(stop_at_m), f(alley), f(holder);
  }
};

/// How a follower sees itself on its path (from its estimate, not from truth).
struct FollowerState {
  static constexpr const char* kType = "FollowerState";
  double lateral_error_m = 0.0;  ///< positive: left of the path
  double heading_error_rad = 0.0;
  double distance_m = 0.0;  ///< along the path
  double remaining_m = 0.0;
  std::int32_t waypoint = 0;  ///< current index
  bool finished = false;

  template <class F>
  void fields(F&& f) {
    f(lateral_error_m), f(heading_error_rad), f(distance_m), f(remaining_m), f(waypoint),
        f(finished);
  }
};

}  // namespace vinerow
