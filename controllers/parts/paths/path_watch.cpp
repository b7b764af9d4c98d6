#include "controllers/parts/paths/path_watch.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/api/parameter_table.h"

namespace vinerow::controllers {
namespace {

/// A vehicle that begins beside its path drives there first, in a bow.
constexpr double kBow = 3.0;

}  // namespace

const ParameterTable<PathWatchParams>& path_watch_table() {
  using P = PathWatchParams;
  static const ParameterTable<P> table = ParameterTable<P>().number(
      "lost_m", "m", &P::lost_m, between(0.1, 1e4),
      "so far from its path, beyond the nearest it has been, the vehicle has lost it and fails; "
      "likewise after ten times that way without getting on along it");
  return table;
}

void PathWatch::update(const Cycle& cycle) {
  if (is_lost()) return;
  const double gap_m = (cycle.p_W - cycle.on_path).norm();
  nearest_m_ = std::min(nearest_m_, gap_m);
  if (cycle.distance_m > farthest_m_) {
    farthest_m_ = cycle.distance_m;
    way_m_ = 0.0;
    allowed_m_ = kWayShare * params_.lost_m + kBow * gap_m;
  }
  way_m_ += cycle.way_m;
  const auto where = [&] {
    return fmt::format("at ({:.2f}, {:.2f}), {:.1f} m along its path of {:.1f} m", cycle.p_W.x(),
                       cycle.p_W.y(), cycle.distance_m, cycle.length_m);
  };
  if (gap_m > nearest_m_ + params_.lost_m) {
    failure_ = fmt::format("lost its path: {:.1f} m away from it {}", gap_m, where());
  } else if (way_m_ > allowed_m_) {
    failure_ =
        fmt::format("lost its path: it has driven {:.0f} m without getting on {}", way_m_, where());
  }
}

}  // namespace vinerow::controllers
