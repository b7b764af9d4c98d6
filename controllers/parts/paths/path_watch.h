#pragma once
/// Detector for a ground vehicle that has lost its path: it is too far from it, or drives on
/// without progress along it (a circle around a waypoint, wheels that spin at a trunk), or the path
/// passes by while it hardly drives, as one does that begins far away.
///
/// A vehicle may start far from its path. The allowed distance is therefore counted from the
/// smallest distance so far: it may return from anywhere, but not depart again. Distance driven is
/// counted as commanded, because the jumps of a noisy estimate add up while a vehicle is
/// stationary.

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>

#include "engine/api/parameter_table_fwd.h"

namespace vinerow::controllers {

struct PathWatchParams {
  double lost_m = 5.0;  ///< farther from the path than this counts as lost
};

/// Parameter `lost_m` of every follower of ground vehicles.
const ParameterTable<PathWatchParams>& path_watch_table();

class PathWatch {
 public:
  /// Distance that a vehicle may drive without progress along its path, in units of `lost_m`.
  static constexpr double kDistanceShare = 10.0;

  explicit PathWatch(const PathWatchParams& params) : params_(params) {}

  /// Another path.
  void reset() { *this = PathWatch(params_); }

  struct Cycle {
    Eigen::Vector2d p_W;      ///< estimated position
    Eigen::Vector2d on_path;  ///< the corresponding point of the path
    double distance_m = 0.0;  ///< along the path
    double length_m = 0.0;    ///< of the path
    double travel_m = 0.0;    ///< commanded in this cycle, >= 0
    bool is_finished = false;
  };
  /// Once per cycle while following. No heap except for the sentence.
  void update(const Cycle& cycle);

  bool is_lost() const { return !failure_.empty(); }
  const std::string& failure() const { return failure_; }

 private:
  PathWatchParams params_;
  double nearest_m_ = std::numeric_limits<double>::infinity();    ///< smallest distance so far
  double farthest_m_ = -std::numeric_limits<double>::infinity();  ///< along the path
  double distance_m_ = 0.0;                                       ///< driven since farthest_m_
  double allowed_m_ = 0.0;                 ///< distance that may be driven without progress
  std::optional<Eigen::Vector2d> last_W_;  ///< position in the cycle before
  double first_m_ = 0.0;                   ///< along the path in the first cycle
  double moved_m_ = 0.0;                   ///< since then, commanded or estimated
  std::string failure_;
};

}  // namespace vinerow::controllers
