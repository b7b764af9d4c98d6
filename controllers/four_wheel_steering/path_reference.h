#pragma once
/// What the path asks of a vehicle whose steering has a rate limit: errors and curvature to drive.
///
/// A path of straights and arcs has steps of curvature, which no steering follows. Its curvature is
/// therefore averaged over a window as long as the vehicle needs to swing its axles from one side
/// to the other; a step becomes a ramp of that length, half of it before the step, and the vehicle
/// ends up beside the path by only step * length^2 / 24. The heading error is measured against the
/// heading of the averaged path, so that feedback does not fight the ramp.
///
/// On a slope the path in plan is not the path on the ground: along a line of height h it bends
/// more by 1 / cos(slope), straight uphill less by cos^2(slope). With n the ground's normal and t
/// the direction of travel, kappa_ground = kappa_plan cos^3(rise along t) / n_z.

#include <Eigen/Geometry>

#include "controllers/parts/paths/path_curve.h"
#include "engine/api/forward.h"

namespace vinerow::controllers {

/// Where a vehicle is on its path and what it is to drive there.
struct PathReference {
  Path::Nearest at;
  double heading_error_rad = 0.0;         ///< of the nose against the path's direction
  double smooth_heading_error_rad = 0.0;  ///< against that of the averaged path
  double curvature_per_m = 0.0;           ///< averaged and previewed, in plan
};

struct PathReferenceParams {
  double swing_s = 0.4;     ///< time to swing the axles from one limit to the other
  double response_s = 0.0;  ///< further time by which the steering lags
};

/// Follows one path from its start to its end; never jumps to another pass of it.
class PathTracker {
 public:
  explicit PathTracker(const PathReferenceParams& params) : params_(params) {}

  /// Allocates.
  void set_path(const PlannedPath& plan);
  const Path& path() const { return path_; }

  /// @pre the path is not empty  @param speed_mps  that it is driven with. No heap.
  PathReference update(const Pose2& pose, double speed_mps);

 private:
  PathReferenceParams params_;
  Path path_;
  double distance_m_ = -1.0;
  int segment_ = 0;
};

/// Factor from the curvature in plan to that on the ground the vehicle stands on.
/// @param q_WB  attitude, its z the ground's normal  @param yaw_rad  direction of travel in plan
double calc_slope_factor(const Eigen::Quaterniond& q_WB, double yaw_rad);

}  // namespace vinerow::controllers
