#pragma once
/// Messages about paths: a plan, how far it may be followed, and how a follower does on it.
/// Frames and units: engine/api/messages.h.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/api/field.h"

namespace vinerow {

/// Straight pieces in W, two points each: a planner's tree. ROS 2: visualization_msgs/msg/Marker
/// (LINE_LIST).
struct LineList {
  static constexpr const char* kType = "LineList";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  std::vector<Eigen::Vector3d> points_W;  ///< an even number

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"points", "m", "two a piece"}, self.points_W);
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

inline std::span<const EnumName> enum_names(PathKind) {
  using enum PathKind;
  static constexpr EnumName kNames[] = {
      enum_name(kLeg, "LEG"),
      enum_name(kTurn, "TURN"),
      enum_name(kTransit, "TRANSIT"),
      enum_name(kVertical, "VERTICAL"),
      enum_name(kReturn, "RETURN")};
  return kNames;
}

/// One point of a path; the stretch from this point to the next has `kind`.
struct PathPoint {
  static constexpr const char* kType = "PathPoint";
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;          ///< direction of travel
  double curvature_per_m = 0.0;  ///< of the stretch that starts here, positive to the left
  double speed_mps = 0.0;        ///< wanted speed; 0 = the follower's own
  PathKind kind = PathKind::kLeg;
  std::int32_t alley = -1;  ///< index of the alley a leg runs in, -1 elsewhere

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"position", "m"}, self.p_W);
    f({"yaw", "rad", "direction of travel"}, self.yaw_rad);
    f({"curvature", "1/m", "positive to the left, of the stretch that starts here"},
      self.curvature_per_m);
    f({"speed", "m/s", "0: the follower's own"}, self.speed_mps);
    f({"kind"}, self.kind);
    f({"alley", "", "index of the alley a leg runs in, -1 elsewhere"}, self.alley);
  }
};

/// What a follower is to drive. ROS 2: nav_msgs/msg/Path.
struct PlannedPath {
  static constexpr const char* kType = "PlannedPath";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  std::vector<PathPoint> points;
  double length_m = 0.0;  ///< of the exact curve, not of the polyline

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"points"}, self.points);
    f({"length", "m", "of the exact curve"}, self.length_m);
  }
};

/// How far a vehicle may go along its plan: what whoever shares the alleys out grants it. Without
/// one it may go to the end. ROS 2: vinerow_msgs/msg/MovementAuthority.
struct MovementAuthority {
  static constexpr const char* kType = "MovementAuthority";
  double stop_at_m = 0.0;     ///< distance along the plan at which to stand still; +infinity: none
  std::int32_t alley = -1;    ///< waited for; -1: none
  std::string holder;         ///< vehicle that has it; "" where nobody is waited for

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"stop_at", "m", "along the plan; +inf: to its end"}, self.stop_at_m);
    f({"alley", "", "waited for; -1: none"}, self.alley);
    f({"holder", "", "who has it"}, self.holder);
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

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"lateral_error", "m", "positive left of the path"}, self.lateral_error_m);
    f({"heading_error", "rad"}, self.heading_error_rad);
    f({"distance", "m", "along the path"}, self.distance_m);
    f({"remaining", "m"}, self.remaining_m);
    f({"waypoint"}, self.waypoint);
    f({"finished"}, self.finished);
  }
};

}  // namespace vinerow
