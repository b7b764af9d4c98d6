#pragma once
/// Path messages: a plan, the distance up to which it may be followed, and the state of a follower
/// on it. Frames and units: engine/api/messages.h.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/api/field.h"

namespace vinerow {

/// Line segments in W, two points each: a planner's tree. ROS 2: visualization_msgs/msg/Marker
/// (LINE_LIST).
struct LineList {
  static constexpr const char* kType = "LineList";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  std::vector<Eigen::Vector3d> points_W;  ///< an even number

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"points", "m", "two per segment"}, self.points_W);
  }
};

/// Purpose of a stretch of path. Metrics judge legs and turns apart.
enum class PathKind : std::uint8_t {
  kLeg = 0,
  kTurn = 1,
  kTransit = 2,
  kVertical = 3,  ///< straight up or down: a take-off, a landing
  kReturn = 4     ///< return path after the last leg
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

/// Point of a path. `kind` is that of the stretch from this point to the next.
struct PathPoint {
  static constexpr const char* kType = "PathPoint";
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;          ///< direction of travel
  double curvature_per_m = 0.0;  ///< of the stretch that starts here, positive to the left
  double speed_mps = 0.0;        ///< desired speed; 0 = the follower's own
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

/// Path for a follower. ROS 2: nav_msgs/msg/Path.
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

/// Movement authority: distance along its plan up to which a vehicle may go, granted by the traffic
/// control of the alleys. Without one it may go to the end. ROS 2:
/// vinerow_msgs/msg/MovementAuthority.
struct MovementAuthority {
  static constexpr const char* kType = "MovementAuthority";
  double stop_at_m = 0.0;     ///< distance along the plan at which to stop; +infinity: none
  std::int32_t alley = -1;    ///< alley that the vehicle waits for; -1: none
  std::string holder;         ///< vehicle that occupies it; "" if nobody does

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"stop_at", "m", "along the plan; +inf: to its end"}, self.stop_at_m);
    f({"alley", "", "that the vehicle waits for; -1: none"}, self.alley);
    f({"holder", "", "vehicle that occupies the alley"}, self.holder);
  }
};

/// State of a follower on its path, from its estimate, not from the truth.
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
