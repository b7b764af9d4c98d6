#pragma once
/// Which ROS 2 message each signal type becomes, and how its bytes are written and read back.
///
/// The first channel of a signal has the standard ROS 2 type. Where that type cannot hold the whole
/// value (single precision, missing fields), a second channel "<topic>/exact" with a type of our
/// own does; reading back uses the exact one. README.md has the table and its reasons.

#include <string>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/messages/flight.h"
#include "engine/api/messages/grid.h"
#include "engine/api/messages/motion.h"
#include "engine/api/messages/path.h"
#include "engine/api/messages/sensors.h"
#include "engine/core/time.h"
#include "engine/math/pose.h"
#include "engine/record/cdr.h"

namespace vinerow::record {

/// Frame names in the messages of one signal.
struct FrameNames {
  std::string world = "map";
  std::string body;    ///< "rover/base_link"
  std::string own;     ///< "rover/gps"
  std::string prefix;  ///< "rover/", before the names of links

  /// @param signal  "rover/gps"
  static FrameNames of_signal(const std::string& signal);
};

/// What a message says beside the value.
struct WriteContext {
  const FrameNames& frames;
  Time stamp;
  /// Where the vehicle's body was at `stamp`, if it is known: poses of its links and sensors are
  /// then stored relative to it, rounded to kPoseGrid, because a log is mostly the noise of poses.
  const Pose* X_WB = nullptr;
};

/// Step of positions (m) and quaternion components in poses relative to the body: about 1 nm and
/// 2 nrad, a power of two, so that a rounded number has few bits and a fixed mounting is the same
/// bytes in every message.
constexpr double kPoseGrid = 0x1p-30;

/// @tparam T one of the types of messages.h
template <class T>
struct RosMapping;

/// What every mapping has. `read` fills all fields of T from what write_exact wrote, or write if
/// kExactType is null. @returns false if the bytes do not hold such a message
#define VINEROW_ROS_MAPPING(T, type, exact_type)                        \
  template <>                                                           \
  struct RosMapping<T> {                                                \
    static constexpr const char* kType = type;                          \
    static constexpr const char* kExactType = exact_type;               \
    static void write(CdrWriter&, const WriteContext&, const T&);       \
    static void write_exact(CdrWriter&, const WriteContext&, const T&); \
    static bool read(CdrReader&, const FrameNames&, T&);                \
  };

VINEROW_ROS_MAPPING(Odometry, "nav_msgs/msg/Odometry", nullptr)
VINEROW_ROS_MAPPING(ImuSample, "sensor_msgs/msg/Imu", nullptr)
VINEROW_ROS_MAPPING(GnssFix, "sensor_msgs/msg/NavSatFix", "vinerow_msgs/msg/GnssFix")
VINEROW_ROS_MAPPING(RangeSample, "sensor_msgs/msg/Range", "vinerow_msgs/msg/RangeRay")
VINEROW_ROS_MAPPING(PressureSample, "sensor_msgs/msg/FluidPressure", nullptr)
VINEROW_ROS_MAPPING(MagneticSample, "sensor_msgs/msg/MagneticField", nullptr)
VINEROW_ROS_MAPPING(LaserScan, "sensor_msgs/msg/LaserScan", "vinerow_msgs/msg/LaserScan")
VINEROW_ROS_MAPPING(PositionEllipsoid, "geometry_msgs/msg/PoseWithCovarianceStamped", nullptr)
VINEROW_ROS_MAPPING(VelocityCommand, "geometry_msgs/msg/TwistStamped", nullptr)
VINEROW_ROS_MAPPING(LocalCommand, "vinerow_msgs/msg/LocalCommand", nullptr)
VINEROW_ROS_MAPPING(LineList, "visualization_msgs/msg/Marker", nullptr)
VINEROW_ROS_MAPPING(OccupancyGrid, "nav_msgs/msg/OccupancyGrid", "vinerow_msgs/msg/OccupancyGrid")
VINEROW_ROS_MAPPING(NamedValues, "vinerow_msgs/msg/NamedValues", nullptr)
VINEROW_ROS_MAPPING(LinkPoses, "tf2_msgs/msg/TFMessage", nullptr)
VINEROW_ROS_MAPPING(PlannedPath, "nav_msgs/msg/Path", "vinerow_msgs/msg/PlannedPath")
VINEROW_ROS_MAPPING(FollowerState, "vinerow_msgs/msg/FollowerState", nullptr)
VINEROW_ROS_MAPPING(MovementAuthority, "vinerow_msgs/msg/MovementAuthority", nullptr)
VINEROW_ROS_MAPPING(ReferenceTrajectory, "trajectory_msgs/msg/MultiDOFJointTrajectory",
                    "vinerow_msgs/msg/ReferenceTrajectory")
VINEROW_ROS_MAPPING(AirReference, "vinerow_msgs/msg/AirReference", nullptr)
VINEROW_ROS_MAPPING(AirData, "geometry_msgs/msg/Vector3Stamped", nullptr)
VINEROW_ROS_MAPPING(CameraShot, "vinerow_msgs/msg/CameraShot", nullptr)
VINEROW_ROS_MAPPING(BatteryState, "sensor_msgs/msg/BatteryState", "vinerow_msgs/msg/BatteryState")
VINEROW_ROS_MAPPING(Event, "rcl_interfaces/msg/Log", nullptr)

#undef VINEROW_ROS_MAPPING

}  // namespace vinerow::record
