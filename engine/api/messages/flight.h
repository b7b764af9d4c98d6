#pragma once
/// Messages that say where a flying vehicle should be.
/// Frames and units: engine/api/messages.h.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace vinerow {

/// Where a flying vehicle should be at one moment.
struct TrajectoryPoint {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< of B's origin, m
  Eigen::Vector3d v_W = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Vector3d a_W = Eigen::Vector3d::Zero();  ///< m/s2
  double yaw_rad = 0.0;                           ///< continuous, not wrapped
  double yaw_rate_radps = 0.0;
};

/// Where a flying vehicle should be now and in the coming moments: points[i] holds at the signal's
/// stamp + i dt_s. ROS 2: trajectory_msgs/msg/MultiDOFJointTrajectory.
struct ReferenceTrajectory {
  static constexpr const char* kType = "ReferenceTrajectory";
  enum class Phase : std::uint8_t {
    kWait = 0,     ///< on the ground, rotors off
    kTakeOff = 1,  ///< straight up
    kTransit = 2,  ///< to the first row
    kRow = 3,
    kTurn = 4,
    kReturn = 5,  ///< home, above the canopy
    kLand = 6,    ///< straight down, until the ground is felt
    kDone = 7,    ///< landed: rotors off, nothing left to do
    kHover = 8    ///< holds a place
  };
  double dt_s = 0.05;
  std::vector<TrajectoryPoint> points;  ///< constant in number from the first to the last tick
  Phase phase = Phase::kWait;
  double distance_m = 0.0;  ///< flown along the plan
  double remaining_m = 0.0;

  template <class F>
  void fields(F&& f) {
    f(dt_s);
    for (TrajectoryPoint& point : points) {
      f(point.p_W), f(point.v_W), f(point.a_W), f(point.yaw_rad), f(point.yaw_rate_radps);
    }
    f(phase), f(distance_m), f(remaining_m);
  }
};

/// What a vehicle on wings is to hold now. ROS 2: vinerow_msgs/msg/AirReference.
struct AirReference {
  static constexpr const char* kType = "AirReference";
  enum class Phase : std::uint8_t {
    kWait = 0,      ///< on the launcher, propeller off
    kLaunch = 1,    ///< straight ahead and up
    kStraight = 2,  ///< along a leg, or on the way to it
    kTurn = 3,
    kLoiter = 4,  ///< circles
    kLand = 5,    ///< down to the ground; the propeller stops where `power` says so
    kDone = 6     ///< nothing left to do: on the ground, or circling where `power` is on
  };
  Phase phase = Phase::kWait;
  bool power = false;         ///< whether the propeller may run
  double airspeed_mps = 0.0;  ///< true airspeed
  double course_rad = 0.0;    ///< of the velocity over ground, from east, positive to the left
  double heading_rad = 0.0;   ///< of body x: the course, crabbed by the wind; continuous
  double heading_rate_radps = 0.0;
  double bank_rad = 0.0;  ///< roll that this turn takes, positive to the right (right wing down)
  double height_m = 0.0;  ///< z of W
  double climb_angle_rad = 0.0;                      ///< of the path through the air
  Eigen::Vector3d wind_W = Eigen::Vector3d::Zero();  ///< mean wind as far as it is known, m/s
  double cross_track_m = 0.0;                        ///< of the leg flown, positive: left of it
  std::int32_t waypoint = 0;                         ///< flown to
  double distance_m = 0.0;                           ///< along the plan
  double remaining_m = 0.0;

  template <class F>
  void fields(F&& f) {
    f(phase), f(power), f(airspeed_mps), f(course_rad), f(heading_rad), f(heading_rate_radps);
    f(bank_rad), f(height_m), f(climb_angle_rad), f(wind_W), f(cross_track_m), f(waypoint);
    f(distance_m), f(remaining_m);
  }
};

}  // namespace vinerow
