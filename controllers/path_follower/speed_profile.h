#pragma once
/// Speed profile of a path: lateral acceleration and yaw rate in turns, braking before them.

#include <vector>

#include "controllers/parts/paths/path_curve.h"

namespace vinerow::controllers {

struct SpeedLimits {
  double speed_mps = 7.0 / 3.6;
  double acceleration_mps2 = 0.8;          ///< along the path, both ways
  double lateral_acceleration_mps2 = 1.0;  ///< v^2 |kappa|
  double yaw_rate_radps = 0.6;             ///< v |kappa|
  double goal_speed_mps = 0.1;             ///< at the path's end and at sharp corners
  double corner_m = 0.6;                   ///< distance over which lesser corners are rounded
};

/// Largest speed at each place, so that braking with the given acceleration meets every slower
/// stretch ahead: v(s)^2 = v(s_end)^2 + 2 a (s_end - s), swept backwards over the segments once per
/// plan. A sharp corner (path_corners.h) is a goal of its own. A lesser corner limits the speed
/// like a curve that turns by the same angle over `corner_m`.
class SpeedProfile {
 public:
  SpeedProfile() = default;
  SpeedProfile(const Path& path, const SpeedLimits& limits);

  /// @param segment  that contains the distance
  double speed_at(const Path& path, int segment, double distance_m) const;

 private:
  struct Stretch {
    double cap_mps;  ///< on the stretch itself
    double end_mps;  ///< at its end
  };
  double acceleration_mps2_ = 1.0;
  std::vector<Stretch> stretches_;
};

}  // namespace vinerow::controllers
