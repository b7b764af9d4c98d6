#pragma once
/// Mapping of signal types to ROS 2 messages, with encoding and decoding.
///
/// Types with a suitable standard ROS 2 message are mapped to it by hand. If the standard message
/// cannot hold the exact value (single precision, missing fields), a second channel "<topic>/exact"
/// holds every field by the message's own description, and reading uses that channel. Types without
/// a standard message use only their description (described_message.h). README.md has the table and
/// its reasons.

#include <array>
#include <string>
#include <string_view>

#include "engine/api/messages.h"
#include "engine/record/cdr.h"
#include "engine/record/described_message.h"
#include "engine/record/ros_definitions.h"
#include "engine/record/write_context.h"

namespace vinerow::record {

/// Order of fields in logs, for messages whose log layout is older than their field list.
template <class T>
inline constexpr std::array<std::string_view, 0> kLogOrder{};
template <>
inline constexpr std::array<std::string_view, 10> kLogOrder<GnssFix> = {
    "valid",    "latitude",     "longitude",    "altitude", "position",
    "velocity", "position_std", "velocity_std", "mode",     "satellites"};
template <>
inline constexpr std::array<std::string_view, 6> kLogOrder<OccupancyGrid> = {
    "cell", "corner_x", "corner_y", "columns", "rows", "cells"};
template <>
inline constexpr std::array<std::string_view, 2> kLogOrder<PlannedPath> = {"length", "points"};
template <>
inline constexpr std::array<std::string_view, 5> kLogOrder<ReferenceTrajectory> = {
    "phase", "distance", "remaining", "step", "points"};

/// Mapping of a message by its own description.
template <class T>
struct DescribedMapping {
  static void write(CdrWriter& out, const WriteContext& to, const T& value) {
    write_described(out, to, frame_of<T>(), kLogOrder<T>, FieldsOf<T>(value));
  }
  static bool read(CdrReader& in, const FrameNames&, T& value) {
    return read_described(in, kLogOrder<T>, value);
  }
  /// @param ros_type  name of the message
  static std::string definition(std::string_view ros_type) {
    const T fresh{};
    return described_definition(ros_type, kLogOrder<T>, FieldsOf<T>(fresh));
  }
};

/// Interface of all mappings. `read` fills all fields of T from the bytes of write_exact, or of
/// write if exact_type() is empty. It returns false if the bytes are not such a message.
template <class T>
struct RosMapping {
  static std::string type() { return ros_type_of(T::kType); }
  static std::string exact_type() { return {}; }
  static std::string definition() { return DescribedMapping<T>::definition(type()); }
  static void write(CdrWriter& out, const WriteContext& to, const T& value) {
    DescribedMapping<T>::write(out, to, value);
  }
  static bool read(CdrReader& in, const FrameNames& frames, T& value) {
    return DescribedMapping<T>::read(in, frames, value);
  }
};

/// A standard type that holds the exact value: `write` and `read` by hand.
#define VINEROW_STANDARD_MESSAGE(T, ros_type)                      \
  template <>                                                      \
  struct RosMapping<T> {                                           \
    static std::string type() { return ros_type; }                 \
    static std::string exact_type() { return {}; }                 \
    static std::string definition() {                              \
      return full_ros_definition(type());                          \
    }                                                              \
    static void write(CdrWriter&, const WriteContext&, const T&);  \
    static bool read(CdrReader&, const FrameNames&, T&);           \
  };
/// A standard type that does not hold the exact value: `write` by hand, the rest from the
/// description.
#define VINEROW_EXACT_MESSAGE(T, ros_type, ros_exact_type)                                      \
  template <>                                                                                   \
  struct RosMapping<T> {                                                                        \
    static std::string type() { return ros_type; }                                              \
    static std::string exact_type() { return ros_exact_type; }                                  \
    static std::string definition() { return full_ros_definition(type()); }                     \
    static std::string exact_definition() {                                                     \
      return DescribedMapping<T>::definition(exact_type());                                     \
    }                                                                                           \
    static void write(CdrWriter&, const WriteContext&, const T&);                               \
    static void write_exact(CdrWriter& out, const WriteContext& to, const T& value) {           \
      DescribedMapping<T>::write(out, to, value);                                               \
    }                                                                                           \
    static bool read(CdrReader& in, const FrameNames& frames, T& value) {                       \
      return DescribedMapping<T>::read(in, frames, value);                                      \
    }                                                                                           \
  };

VINEROW_STANDARD_MESSAGE(Odometry, "nav_msgs/msg/Odometry")
VINEROW_STANDARD_MESSAGE(DeadReckoning, "nav_msgs/msg/Odometry")
VINEROW_STANDARD_MESSAGE(ImuSample, "sensor_msgs/msg/Imu")
VINEROW_EXACT_MESSAGE(GnssFix, "sensor_msgs/msg/NavSatFix", "vinerow_msgs/msg/GnssFix")
VINEROW_EXACT_MESSAGE(RangeSample, "sensor_msgs/msg/Range", "vinerow_msgs/msg/RangeRay")
VINEROW_STANDARD_MESSAGE(PressureSample, "sensor_msgs/msg/FluidPressure")
VINEROW_STANDARD_MESSAGE(MagneticSample, "sensor_msgs/msg/MagneticField")
VINEROW_EXACT_MESSAGE(LaserScan, "sensor_msgs/msg/LaserScan", "vinerow_msgs/msg/LaserScan")
VINEROW_STANDARD_MESSAGE(PointCloud, "sensor_msgs/msg/PointCloud2")
VINEROW_STANDARD_MESSAGE(Picture, "sensor_msgs/msg/CompressedImage")
VINEROW_STANDARD_MESSAGE(CameraInfo, "sensor_msgs/msg/CameraInfo")
VINEROW_STANDARD_MESSAGE(PositionEllipsoid, "geometry_msgs/msg/PoseWithCovarianceStamped")
VINEROW_STANDARD_MESSAGE(PoseTarget, "geometry_msgs/msg/PoseStamped")
VINEROW_STANDARD_MESSAGE(VelocityCommand, "geometry_msgs/msg/TwistStamped")
VINEROW_STANDARD_MESSAGE(LineList, "visualization_msgs/msg/Marker")
VINEROW_EXACT_MESSAGE(OccupancyGrid, "nav_msgs/msg/OccupancyGrid",
                      "vinerow_msgs/msg/OccupancyGrid")
VINEROW_STANDARD_MESSAGE(LinkPoses, "tf2_msgs/msg/TFMessage")
VINEROW_EXACT_MESSAGE(PlannedPath, "nav_msgs/msg/Path", "vinerow_msgs/msg/PlannedPath")
VINEROW_EXACT_MESSAGE(ReferenceTrajectory, "trajectory_msgs/msg/MultiDOFJointTrajectory",
                      "vinerow_msgs/msg/ReferenceTrajectory")
VINEROW_STANDARD_MESSAGE(AirData, "geometry_msgs/msg/Vector3Stamped")
VINEROW_EXACT_MESSAGE(BatteryState, "sensor_msgs/msg/BatteryState",
                      "vinerow_msgs/msg/BatteryState")
VINEROW_STANDARD_MESSAGE(Event, "rcl_interfaces/msg/Log")

#undef VINEROW_STANDARD_MESSAGE
#undef VINEROW_EXACT_MESSAGE

}  // namespace vinerow::record
