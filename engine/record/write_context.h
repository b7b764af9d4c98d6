#pragma once
/// What a message in a log says beside the value: frames, time, where the vehicle was.

#include <string>

#include "engine/core/time.h"
#include "engine/math/pose.h"

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

}  // namespace vinerow::record
