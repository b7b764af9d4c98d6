#pragma once
/// All clouds of a topic as one cloud in the frame of the map.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/math/pose.h"
#include "engine/playback/log_trace.h"
#include "tools/export/cloud_message.h"
#include "tools/export/map_cloud_file.h"

namespace vinerow::tools {

/// Writes the points of a topic one after the other. Each is moved by the pose that the vehicle has
/// at the point's own time (stamp and field `time`), so that the vehicle's motion within a frame
/// bends nothing.
class MapCloud {
 public:
  /// @param poses  of the vehicle in W; not empty  @param X_BS  mounting of the scanner
  MapCloud(std::unique_ptr<MapCloudFile> file, playback::Trace<Odometry> poses, const Pose& X_BS);

  /// @param message  a PointCloud2 with single-precision x, y, z
  /// @returns false if it is none, or has other fields than those before
  bool add(std::int64_t stamp_ns, std::int64_t logged_ns, std::span<const std::uint8_t> message);
  /// Whether a cloud has been added.
  bool has_begun() const { return has_begun_; }
  /// Completes the file. @pre has_begun() @returns number of points
  std::uint64_t finish();
  /// Points before the first pose or after the last one.
  std::uint64_t without_pose() const { return without_pose_; }

 private:
  /// Places of the fields that change.
  struct Places {
    std::size_t x = 0, y = 0, z = 0;
    std::optional<std::size_t> time;
  };
  bool begin(const std::vector<CloudField>& fields);
  void put_point(const CloudMessage& cloud, std::size_t i, std::int64_t stamp_ns);
  bool move_to(Time t);

  std::unique_ptr<MapCloudFile> file_;
  playback::Trace<Odometry> poses_;
  Pose X_BS_;
  bool has_begun_ = false;
  std::vector<CloudField> fields_;  ///< of the messages
  Places at_;
  std::optional<Time> time_;  ///< of the pose
  Eigen::Matrix3d R_WS_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_WS_ = Eigen::Vector3d::Zero();
  std::uint64_t count_ = 0, without_pose_ = 0;
};

}  // namespace vinerow::tools
