#pragma once
/// Reference messages of flying vehicles. Frames and units: engine/api/messages.h.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/api/field.h"

namespace vinerow {

/// Reference state of a flying vehicle at one moment.
struct TrajectoryPoint {
  static constexpr const char* kType = "TrajectoryPoint";
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< of B's origin, m
  Eigen::Vector3d v_W = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Vector3d a_W = Eigen::Vector3d::Zero();  ///< m/s2
  double yaw_rad = 0.0;                           ///< continuous, not wrapped
  double yaw_rate_radps = 0.0;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"position", "m", "of the body's origin"}, self.p_W);
    f({"velocity", "m/s"}, self.v_W);
    f({"acceleration", "m/s^2"}, self.a_W);
    f({"yaw", "rad", "continuous"}, self.yaw_rad);
    f({"yaw_rate", "rad/s"}, self.yaw_rate_radps);
  }
};

/// Reference trajectory of a rotorcraft: points[i] is for the signal's stamp + i dt_s. ROS 2:
/// trajectory_msgs/msg/MultiDOFJointTrajectory.
struct ReferenceTrajectory {
  static constexpr const char* kType = "ReferenceTrajectory";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  enum class Phase : std::uint8_t {
    kWait = 0,     ///< on the ground, rotors off
    kTakeOff = 1,  ///< straight up
    kTransit = 2,  ///< to the first row
    kRow = 3,
    kTurn = 4,
    kReturn = 5,  ///< home, above the canopy
    kLand = 6,    ///< straight down, until ground contact is detected
    kDone = 7,    ///< landed: rotors off, nothing left to do
    kHover = 8    ///< holds a position
  };
  double dt_s = 0.05;
  std::vector<TrajectoryPoint> points;  ///< their number is constant from the first to the last
                                        ///< tick
  Phase phase = Phase::kWait;
  double distance_m = 0.0;  ///< flown along the plan
  double remaining_m = 0.0;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"step", "s", "from one point to the next; the first holds at the stamp"}, self.dt_s);
    f({"points"}, self.points);
    f({"phase"}, self.phase);
    f({"distance", "m", "flown along the plan"}, self.distance_m);
    f({"remaining", "m"}, self.remaining_m);
  }
};

inline std::span<const EnumName> enum_names(ReferenceTrajectory::Phase) {
  using enum ReferenceTrajectory::Phase;
  static constexpr EnumName kNames[] = {
      enum_name(kWait, "WAIT"),
      enum_name(kTakeOff, "TAKE_OFF"),
      enum_name(kTransit, "TRANSIT"),
      enum_name(kRow, "ROW"),
      enum_name(kTurn, "TURN"),
      enum_name(kReturn, "RETURN"),
      enum_name(kLand, "LAND"),
      enum_name(kDone, "DONE"),
      enum_name(kHover, "HOVER")};
  return kNames;
}

/// Reference of a winged vehicle. ROS 2: vinerow_msgs/msg/AirReference.
struct AirReference {
  static constexpr const char* kType = "AirReference";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  enum class Phase : std::uint8_t {
    kWait = 0,      ///< on the launcher, propeller off
    kLaunch = 1,    ///< straight ahead and up
    kStraight = 2,  ///< along a leg, or towards it
    kTurn = 3,
    kLoiter = 4,  ///< circles
    kLand = 5,    ///< down to the ground; the propeller stops when `power` is false
    kDone = 6     ///< task complete: on the ground, or circling if `power` is true
  };
  Phase phase = Phase::kWait;
  bool power = false;         ///< whether the propeller may run
  double airspeed_mps = 0.0;  ///< true airspeed
  double course_rad = 0.0;    ///< of the velocity over ground, from east, positive to the left
  double heading_rad = 0.0;   ///< of body x: the course, crabbed by the wind; continuous
  double heading_rate_radps = 0.0;
  double bank_rad = 0.0;  ///< roll for this turn, positive to the right (right wing down)
  double height_m = 0.0;  ///< z of W
  double climb_angle_rad = 0.0;                      ///< of the path through the air
  Eigen::Vector3d wind_W = Eigen::Vector3d::Zero();  ///< estimate of the mean wind, m/s
  double cross_track_m = 0.0;                        ///< from the current leg, positive: left of it
  std::int32_t waypoint = 0;                         ///< index of the current target
  double distance_m = 0.0;                           ///< along the plan
  double remaining_m = 0.0;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"phase"}, self.phase);
    f({"power", "", "whether the propeller may run"}, self.power);
    f({"airspeed", "m/s", "true airspeed"}, self.airspeed_mps);
    f({"course", "rad", "of the velocity over ground, from east, positive to the left"},
      self.course_rad);
    f({"heading", "rad", "of the body, likewise"}, self.heading_rad);
    f({"heading_rate", "rad/s"}, self.heading_rate_radps);
    f({"bank", "rad", "positive with the right wing down"}, self.bank_rad);
    f({"height", "m", "z in header.frame_id"}, self.height_m);
    f({"climb_angle", "rad", "of the path through the air"}, self.climb_angle_rad);
    f({"wind", "m/s", "estimate of the mean wind"}, self.wind_W);
    f({"cross_track", "m", "positive left of the leg"}, self.cross_track_m);
    f({"waypoint"}, self.waypoint);
    f({"distance", "m", "along the plan"}, self.distance_m);
    f({"remaining", "m"}, self.remaining_m);
  }
};

inline std::span<const EnumName> enum_names(AirReference::Phase) {
  using enum AirReference::Phase;
  static constexpr EnumName kNames[] = {
      enum_name(kWait, "WAIT"),
      enum_name(kLaunch, "LAUNCH"),
      enum_name(kStraight, "STRAIGHT"),
      enum_name(kTurn, "TURN"),
      enum_name(kLoiter, "LOITER"),
      enum_name(kLand, "LAND"),
      enum_name(kDone, "DONE")};
  return kNames;
}

}  // namespace vinerow
