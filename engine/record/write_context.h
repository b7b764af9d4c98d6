#pragma once
/// Context of a message in a log: frames, time, pose of the vehicle.

#include <string>
#include <string_view>

#include "engine/core/time.h"
#include "engine/math/pose.h"

namespace vinerow::record {

/// After the vehicle's prefix: frame of its dead reckoning.
constexpr std::string_view kOdometryFrame = "odom";

/// Frame names in the messages of one signal.
struct FrameNames {
  std::string world = "map";
  std::string body;    ///< "rover/base_link"
  std::string own;     ///< "rover/gps"
  std::string prefix;  ///< "rover/", before the names of links

  /// @param signal  "rover/gps"
  static FrameNames of_signal(const std::string& signal);
};

/// Data of a message besides its value.
struct WriteContext {
  const FrameNames& frames;
  Time stamp;
  /// Pose of the vehicle's body at `stamp`; null: unknown. If set, poses of links and sensors are
  /// stored relative to it, rounded to kPoseGrid, because noise in the low bits of poses takes most
  /// of a log's space.
  const Pose* X_WB = nullptr;
  /// Pose of the body by dead reckoning, in the frame "<vehicle>/odom", at `stamp`; null: none.
  const Pose* X_OB = nullptr;
};

/// Step of positions (m) and quaternion components in poses relative to the body: about 1 nm and 2
/// nrad. It is a power of two, so that rounded numbers have few bits and a fixed mounting has the
/// same bytes in every message.
constexpr double kPoseGrid = 0x1p-30;

}  // namespace vinerow::record
