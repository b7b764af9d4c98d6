#pragma once
/// The types of signals. Plain structs in SI units; each lists its fields once (`fields`), which
/// serves the digest, saving and restoring. engine/record maps each to a ROS 2 message.
///
/// Frames: W world (East-North-Up at the scenario's origin), B body (x forward, y left, z up), S
/// sensor.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/api/map.h"
#include "engine/math/pose.h"

namespace vinerow {

/// A symmetric matrix by its diagonal and what is above it (xy, xz, yz).
inline Eigen::Matrix3d symmetric_matrix(const Eigen::Vector3d& diagonal,
                                        const Eigen::Vector3d& beside) {
  Eigen::Matrix3d m = diagonal.asDiagonal();
  m(0, 1) = m(1, 0) = beside.x();
  m(0, 2) = m(2, 0) = beside.y();
  m(1, 2) = m(2, 1) = beside.z();
  return m;
}

/// Pose and twist of a body; truth or estimate. ROS 2: nav_msgs/msg/Odometry.
struct Odometry {
  static constexpr const char* kType = "Odometry";
  Pose X_WB;
  Eigen::Vector3d v_WB_B = Eigen::Vector3d::Zero();  ///< velocity of B's origin, m/s, in B
  Eigen::Vector3d w_WB_B = Eigen::Vector3d::Zero();  ///< angular velocity, rad/s, in B
  /// Of the position's error in W: variances (xx, yy, zz) and covariances (xy, xz, yz), m2; zero
  /// for truth.
  Eigen::Vector3d position_variance_m2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d position_covariance_m2 = Eigen::Vector3d::Zero();
  double yaw_std_rad = 0.0;

  template <class F>
  void fields(F&& f) {
    f(X_WB.p), f(X_WB.q), f(v_WB_B), f(w_WB_B), f(position_variance_m2);
    f(position_covariance_m2), f(yaw_std_rad);
  }

  /// Both as one symmetric matrix.
  Eigen::Matrix3d position_covariance() const {
    return symmetric_matrix(position_variance_m2, position_covariance_m2);
  }
  void set_position_covariance(const Eigen::Matrix3d& covariance_m2) {
    position_variance_m2 = covariance_m2.diagonal();
    position_covariance_m2 = {covariance_m2(0, 1), covariance_m2(0, 2), covariance_m2(1, 2)};
  }
};

/// Inertial measurement. ROS 2: sensor_msgs/msg/Imu.
struct ImuSample {
  static constexpr const char* kType = "ImuSample";
  Eigen::Vector3d w_WS_S = Eigen::Vector3d::Zero();  ///< rate gyro, rad/s
  Eigen::Vector3d f_WS_S =
      Eigen::Vector3d::Zero();  ///< specific force (at rest on level ground: +g along z), m/s2

  template <class F>
  void fields(F&& f) {
    f(w_WS_S), f(f_WS_S);
  }
};

/// Satellite position fix, both in WGS84 and in W. ROS 2: sensor_msgs/msg/NavSatFix.
struct GnssFix {
  static constexpr const char* kType = "GnssFix";
  enum class Mode : std::uint8_t {
    kNone = 0,
    kStandalone = 1,  ///< code measurements alone
    kSbas = 2,        ///< with corrections from satellites
    kFloat = 3,       ///< carrier phase, ambiguities not resolved
    kFixed = 4        ///< carrier phase, ambiguities resolved
  };
  bool valid = false;
  Mode mode = Mode::kNone;      ///< kNone too where the receiver's model knows no modes
  std::int32_t satellites = 0;  ///< used; 0 where the model knows none
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double altitude_m = 0.0;                          ///< above the ellipsoid
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();    ///< antenna, m
  Eigen::Vector3d v_W = Eigen::Vector3d::Zero();    ///< m/s
  Eigen::Vector3d std_m = Eigen::Vector3d::Zero();  ///< 1 sigma east, north, up
  double velocity_std_mps = 0.0;                    ///< 1 sigma of each component; 0: not told

  template <class F>
  void fields(F&& f) {
    f(valid), f(mode), f(satellites), f(velocity_std_mps), f(latitude_rad), f(longitude_rad),
        f(altitude_m), f(p_W), f(v_W), f(std_m);
  }
};

/// One range reading along x of S. ROS 2: sensor_msgs/msg/Range.
struct RangeSample {
  static constexpr const char* kType = "RangeSample";
  double range_m = 0.0;  ///< +infinity if nothing was seen
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  double half_angle_rad = 0.0;
  Pose X_WS;  ///< true pose of the sensor at the reading, for pictures and checks

  template <class F>
  void fields(F&& f) {
    f(range_m), f(min_range_m), f(max_range_m), f(half_angle_rad), f(X_WS.p), f(X_WS.q);
  }
};

/// Static pressure of the air. ROS 2: sensor_msgs/msg/FluidPressure.
struct PressureSample {
  static constexpr const char* kType = "PressureSample";
  double pressure_Pa = 0.0;
  double std_Pa = 0.0;

  template <class F>
  void fields(F&& f) {
    f(pressure_Pa), f(std_Pa);
  }
};

/// Flux density of the magnetic field. ROS 2: sensor_msgs/msg/MagneticField.
struct MagneticSample {
  static constexpr const char* kType = "MagneticSample";
  Eigen::Vector3d field_S_T = Eigen::Vector3d::Zero();  ///< tesla, in S
  double std_T = 0.0;                                   ///< 1 sigma of each component

  template <class F>
  void fields(F&& f) {
    f(field_S_T), f(std_T);
  }
};

/// One turn of a scanning rangefinder in the plane z = 0 of S. ROS 2: sensor_msgs/msg/LaserScan.
struct LaserScan {
  static constexpr const char* kType = "LaserScan";
  double first_angle_rad = 0.0;  ///< of ranges_m[0], from x of S towards y
  double angle_step_rad = 0.0;
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  std::vector<double> ranges_m;  ///< +infinity where nothing was seen; constant in number
  Pose X_WS;                     ///< true pose of the sensor at the stamp, for pictures and checks

  template <class F>
  void fields(F&& f) {
    f(first_angle_rad), f(angle_step_rad), f(min_range_m), f(max_range_m), f(ranges_m);
    f(X_WS.p), f(X_WS.q);
  }
};

/// A set that is to contain the true position: (p - c)' P^-1 (p - c) <= 1. ROS 2:
/// geometry_msgs/msg/PoseWithCovarianceStamped.
struct PositionEllipsoid {
  static constexpr const char* kType = "PositionEllipsoid";
  Eigen::Vector3d centre_W = Eigen::Vector3d::Zero();
  /// P in W: diagonal (xx, yy, zz) and what is beside it (xy, xz, yz), m2.
  Eigen::Vector3d shape_diagonal_m2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d shape_beside_m2 = Eigen::Vector3d::Zero();

  template <class F>
  void fields(F&& f) {
    f(centre_W), f(shape_diagonal_m2), f(shape_beside_m2);
  }
};

/// Wanted forward and turning speed of a ground vehicle. ROS 2: geometry_msgs/msg/TwistStamped.
struct VelocityCommand {
  static constexpr const char* kType = "VelocityCommand";
  double v_mps = 0.0;
  double yaw_rate_radps = 0.0;

  template <class F>
  void fields(F&& f) {
    f(v_mps), f(yaw_rate_radps);
  }
};

/// What a local planner wants of a vehicle with two steered axles. ROS 2:
/// vinerow_msgs/msg/LocalCommand.
struct LocalCommand {
  static constexpr const char* kType = "LocalCommand";
  enum class Mode : std::uint8_t {
    kFollow = 0,  ///< follow the plan, not faster than v_mps
    kDrive = 1,   ///< drive with these axle angles at v_mps (negative: backwards)
    kStop = 2     ///< stand still until told otherwise
  };
  Mode mode = Mode::kStop;
  double v_mps = 0.0;
  double front_axle_rad = 0.0;  ///< positive to the left
  double rear_axle_rad = 0.0;
  double clearance_m = 0.0;  ///< least distance to anything known on the way chosen, m

  template <class F>
  void fields(F&& f) {
    f(mode), f(v_mps), f(front_axle_rad), f(rear_axle_rad), f(clearance_m);
  }
};

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

/// Named numbers of one kind: actuator commands, wheel states. Names are fixed when the writer
/// connects. ROS 2: vinerow_msgs/msg/NamedValues (see record/).
struct NamedValues {
  static constexpr const char* kType = "NamedValues";
  std::vector<std::string> names;
  std::vector<double> values;

  template <class F>
  void fields(F&& f) {
    f(names), f(values);
  }
};

/// Poses of the moving links of a vehicle in W, for pictures and /tf. ROS 2:
/// tf2_msgs/msg/TFMessage.
struct LinkPoses {
  static constexpr const char* kType = "LinkPoses";
  std::vector<std::string> names;
  std::vector<Pose> X_WL;

  template <class F>
  void fields(F&& f) {
    f(names);
    for (Pose& pose : X_WL) f(pose.p), f(pose.q);
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

/// Velocity through the air, as a pitot tube with vanes tells it. ROS 2:
/// geometry_msgs/msg/Vector3Stamped.
struct AirData {
  static constexpr const char* kType = "AirData";
  Eigen::Vector3d v_air_B = Eigen::Vector3d::Zero();  ///< of the vehicle through the air, m/s

  template <class F>
  void fields(F&& f) {
    f(v_air_B);
  }
};

/// One picture taken from above. ROS 2: vinerow_msgs/msg/CameraShot.
struct CameraShot {
  static constexpr const char* kType = "CameraShot";
  std::int32_t index = -1;  ///< counted from 0; -1: none yet
  Pose X_WS;                ///< x of S along the optical axis, y to the picture's left, z up in it
  /// Where the picture's corners meet the ground: upper left, upper right, lower right, lower left,
  /// m. Only where `on_ground`.
  std::array<Eigen::Vector3d, 4> corners_W = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                              Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  bool on_ground = false;   ///< every corner meets the ground
  double distance_m = 0.0;  ///< to the ground along the optical axis
  double gsd_m = 0.0;       ///< ground sampling distance there

  template <class F>
  void fields(F&& f) {
    f(index), f(X_WS.p), f(X_WS.q);
    for (Eigen::Vector3d& corner : corners_W) f(corner);
    f(on_ground), f(distance_m), f(gsd_m);
  }
};

/// Electric energy. ROS 2: sensor_msgs/msg/BatteryState.
struct BatteryState {
  static constexpr const char* kType = "BatteryState";
  double power_W = 0.0;        ///< drawn now, positive when discharging
  double energy_used_J = 0.0;  ///< since the start
  double charge = 1.0;         ///< remaining share of the capacity

  template <class F>
  void fields(F&& f) {
    f(power_W), f(energy_used_J), f(charge);
  }
};

/// What happened, for people: phase changes, contacts, warnings. ROS 2: rcl_interfaces/msg/Log.
struct Event {
  static constexpr const char* kType = "Event";
  enum class Level : std::uint8_t { kInfo = 20, kWarning = 30, kError = 40 };
  Level level = Level::kInfo;
  std::string source;  ///< "rover.controller"
  std::string text;

  template <class F>
  void fields(F&& f) {
    f(level), f(source), f(text);
  }
};

/// Calls `f` once per message type with a null pointer of that type: the closed list of signal
/// types.
template <class F>
void for_each_message_type(F&& f) {
  f(static_cast<Odometry*>(nullptr));
  f(static_cast<ImuSample*>(nullptr));
  f(static_cast<GnssFix*>(nullptr));
  f(static_cast<RangeSample*>(nullptr));
  f(static_cast<PressureSample*>(nullptr));
  f(static_cast<MagneticSample*>(nullptr));
  f(static_cast<LaserScan*>(nullptr));
  f(static_cast<PositionEllipsoid*>(nullptr));
  f(static_cast<VelocityCommand*>(nullptr));
  f(static_cast<LocalCommand*>(nullptr));
  f(static_cast<LineList*>(nullptr));
  f(static_cast<OccupancyGrid*>(nullptr));
  f(static_cast<NamedValues*>(nullptr));
  f(static_cast<LinkPoses*>(nullptr));
  f(static_cast<PlannedPath*>(nullptr));
  f(static_cast<FollowerState*>(nullptr));
  f(static_cast<MovementAuthority*>(nullptr));
  f(static_cast<ReferenceTrajectory*>(nullptr));
  f(static_cast<AirReference*>(nullptr));
  f(static_cast<AirData*>(nullptr));
  f(static_cast<CameraShot*>(nullptr));
  f(static_cast<BatteryState*>(nullptr));
  f(static_cast<Event*>(nullptr));
}

}  // namespace vinerow
