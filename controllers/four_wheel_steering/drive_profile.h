#pragma once
/// Speed profile of a path for a vehicle with limited steering rate.

#include <vector>

#include "controllers/parts/paths/path_curve.h"

namespace vinerow::controllers {

struct DriveLimits {
  double speed_mps = 1.0;
  double turn_speed_mps = 0.8;     ///< on curved stretches
  double acceleration_mps2 = 0.5;  ///< along the path, both ways
  double goal_speed_mps = 0.05;    ///< at the path's end
  double swing_s = 0.4;            ///< time to swing the axles from one limit to the other
};

/// Largest speed at each place, so that braking with the given acceleration meets every slower
/// place ahead. At steps of curvature the speed is so low that averaging them over the distance of
/// one swing (path_reference.h) leaves the path by no more than some millimetres. Swept backwards
/// once per plan (allocates); queries use no heap.
class DriveProfile {
 public:
  DriveProfile() = default;
  DriveProfile(const Path& path, const DriveLimits& limits);

  /// Largest speed here and half a swing ahead, where the steering starts to move.
  /// @param segment  that contains the distance
  double speed_at(const Path& path, int segment, double distance_m) const;

 private:
  struct Stretch {
    double cap_mps;  ///< on the stretch itself
    double end_mps;  ///< at its end
  };
  double stretch_speed(const Path& path, int segment, double distance_m) const;

  DriveLimits limits_;
  std::vector<Stretch> stretches_;
};

}  // namespace vinerow::controllers
