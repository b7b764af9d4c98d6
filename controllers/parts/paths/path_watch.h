#pragma once
/// Notices that a ground vehicle has lost its path: it is too far from it, or drives on and on
/// without getting along it (a circle around a waypoint, wheels that spin at a trunk).
///
/// A vehicle may begin far from its path. What it may be away is therefore counted from the nearest
/// that it has been so far: it may come back from anywhere, and not go away again. Way is counted
/// as commanded, because a position that a noisy estimate jumps about adds up while it stands.

#include <Eigen/Core>
#include <limits>
#include <string>

#include "engine/api/parameter_table_fwd.h"

namespace vinerow::controllers {

struct PathWatchParams {
  double lost_m = 5.0;  ///< farther from the path than that is lost
};

/// Parameter `lost_m` of every follower of ground vehicles.
const ParameterTable<PathWatchParams>& path_watch_table();

class PathWatch {
 public:
  /// So many times `lost_m` a vehicle may drive without getting on along its path.
  static constexpr double kWayShare = 10.0;

  explicit PathWatch(const PathWatchParams& params) : params_(params) {}

  /// Another path.
  void reset() { *this = PathWatch(params_); }

  struct Cycle {
    Eigen::Vector2d p_W;      ///< where the vehicle is, by its estimate
    Eigen::Vector2d on_path;  ///< the place of its path that it is at
    double distance_m = 0.0;  ///< along the path
    double length_m = 0.0;    ///< of the path
    double way_m = 0.0;       ///< commanded in this cycle, >= 0
  };
  /// Once per cycle while it follows. No heap but for the sentence.
  void update(const Cycle& cycle);

  bool is_lost() const { return !failure_.empty(); }
  const std::string& failure() const { return failure_; }

 private:
  PathWatchParams params_;
  double nearest_m_ = std::numeric_limits<double>::infinity();    ///< that it has been
  double farthest_m_ = -std::numeric_limits<double>::infinity();  ///< along the path
  double way_m_ = 0.0;                                            ///< driven since it was there
  double allowed_m_ = 0.0;  ///< to be driven without getting on
  std::string failure_;
};

}  // namespace vinerow::controllers
