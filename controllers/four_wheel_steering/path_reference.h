#pragma once
/// Reference of a path for a vehicle with limited steering rate: errors and curvature to drive.
///
/// A path of straights and arcs has steps of curvature, which steering cannot follow. Its curvature
/// is therefore averaged over a window as long as the vehicle needs to swing its axles from one
/// limit to the other. A step becomes a ramp of that length, half of it before the step, and the
/// vehicle deviates from the path by only step * length^2 / 24. The heading error is measured
/// against the heading of the averaged path, so that feedback does not counteract the ramp.
///
/// On a slope the path in plan view differs from the path on the ground: along a contour line its
/// curvature on the ground is larger by 1 / cos(slope), straight uphill smaller by cos^2(slope).
/// With n the ground's normal and t the direction of travel, kappa_ground = kappa_plan cos^3(rise
/// along t) / n_z.

#include <Eigen/Geometry>

#include "controllers/parts/paths/path_curve.h"
#include "engine/api/forward.h"

namespace vinerow::controllers {

/// Position of a vehicle on its path and the curvature to drive there.
struct PathReference {
  Path::Nearest at;
  double heading_error_rad = 0.0;         ///< of the nose against the path's direction
  double smooth_heading_error_rad = 0.0;  ///< against that of the averaged path
  double curvature_per_m = 0.0;           ///< averaged and previewed, in plan
};

struct PathReferenceParams {
  double swing_s = 0.4;     ///< time to swing the axles from one limit to the other
  double response_s = 0.0;  ///< additional lag of the steering
};

/// Follows one path from its start to its end; never jumps to another pass of the path.
class PathTracker {
 public:
  explicit PathTracker(const PathReferenceParams& params) : params_(params) {}

  /// Allocates.
  void set_path(const PlannedPath& plan);
  const Path& path() const { return path_; }

  /// @pre the path is not empty  @param speed_mps  of the vehicle along it. No heap.
  PathReference update(const Pose2& pose, double speed_mps);

 private:
  PathReferenceParams params_;
  Path path_;
  double distance_m_ = -1.0;
  int segment_ = 0;
};

/// Factor from the curvature in plan view to the curvature on the ground.
/// @param q_WB  attitude, its z the ground's normal  @param yaw_rad  direction of travel in plan
double calc_slope_factor(const Eigen::Quaterniond& q_WB, double yaw_rad);

}  // namespace vinerow::controllers
