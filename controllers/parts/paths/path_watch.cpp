#include "controllers/parts/paths/path_watch.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/api/parameter_table.h"

namespace vinerow::controllers {
namespace {

/// Distance allowed for the curve from a start beside the path to the path, per distance from it.
constexpr double kBow = 3.0;

/// Path that may pass by: per distance moved, since a vehicle inside of a bend moves less than its
/// place on the path, and beyond that, per `lost_m`. Chosen.
constexpr double kPassing = 3.0, kPassingShare = 2.0;

}  // namespace

const ParameterTable<PathWatchParams>& path_watch_table() {
  using P = PathWatchParams;
  static const ParameterTable<P> table = ParameterTable<P>().number(
      "lost_m", "m", &P::lost_m, between(0.1, 1e4),
      "a vehicle has lost its path and fails if its distance from it exceeds the smallest so far "
      "by this, or if it drives ten times this far without progress along the path");
  return table;
}

void PathWatch::update(const Cycle& cycle) {
  if (is_lost()) return;
  const double gap_m = (cycle.p_W - cycle.on_path).norm();
  nearest_m_ = std::min(nearest_m_, gap_m);
  if (cycle.distance_m > farthest_m_) {
    farthest_m_ = cycle.distance_m;
    distance_m_ = 0.0;
    allowed_m_ = kDistanceShare * params_.lost_m + kBow * gap_m;
  }
  distance_m_ += cycle.travel_m;
  const auto where = [&] {
    return fmt::format("at ({:.2f}, {:.2f}), {:.1f} m along its path of {:.1f} m", cycle.p_W.x(),
                       cycle.p_W.y(), cycle.distance_m, cycle.length_m);
  };
  if (!last_W_) first_m_ = cycle.distance_m;
  const double step_m = last_W_ ? (cycle.p_W - *last_W_).norm() : 0.0;
  last_W_ = cycle.p_W;
  moved_m_ += std::max(cycle.travel_m, step_m);
  const double passed_m = cycle.distance_m - first_m_;
  if (cycle.is_finished && gap_m > params_.lost_m) {
    failure_ = fmt::format("lost its path: {:.1f} m away from its end {}", gap_m, where());
  } else if (passed_m > kPassing * moved_m_ + kPassingShare * params_.lost_m) {
    failure_ = fmt::format(
        "lost its path: {:.1f} m of it passed by while the vehicle moved by {:.1f} m {}; a path "
        "begins where the vehicle is",
        passed_m, moved_m_, where());
  } else if (gap_m > nearest_m_ + params_.lost_m) {
    failure_ = fmt::format("lost its path: {:.1f} m away from it {}", gap_m, where());
  } else if (distance_m_ > allowed_m_) {
    failure_ =
        fmt::format("lost its path: its wheels were commanded to roll {:.0f} m without progress {}",
                    distance_m_, where());
  }
}

}  // namespace vinerow::controllers
