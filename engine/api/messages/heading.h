#pragma once
/// Heading message of two satellite antennas on one vehicle. Frames and units:
/// engine/api/messages.h.

#include <Eigen/Core>

#include "engine/api/field.h"

namespace vinerow {

/// Baseline from a first to a second antenna by carrier phase: heading, and the slope along it.
struct GnssHeading {
  static constexpr const char* kType = "GnssHeading";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  bool valid = false;           ///< ambiguities between the antennas are resolved
  std::int32_t satellites = 0;  ///< used, at the antenna that receives fewer
  double length_m = 0.0;        ///< between the antennas as mounted
  Eigen::Vector3d baseline_W = Eigen::Vector3d::Zero();  ///< first to second antenna, m
  Eigen::Vector3d std_m = Eigen::Vector3d::Zero();       ///< 1 sigma east, north, up
  double heading_rad = 0.0;  ///< of the baseline in the plane, from east to the left
  double heading_std_rad = 0.0;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"valid"}, self.valid);
    f({"satellites"}, self.satellites);
    f({"length", "m", "between the antennas as mounted"}, self.length_m);
    f({"baseline", "m", "first to second antenna in header.frame_id: east, north, up"},
      self.baseline_W);
    f({"baseline_std", "m", "1 sigma east, north, up"}, self.std_m);
    f({"heading", "rad", "of the baseline, from east to the left"}, self.heading_rad);
    f({"heading_std", "rad", "1 sigma"}, self.heading_std_rad);
  }
};

}  // namespace vinerow
