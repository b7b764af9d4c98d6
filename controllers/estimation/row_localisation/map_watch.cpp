#include "controllers/estimation/row_localisation/map_watch.h"

#include <fmt/format.h>

#include <algorithm>

namespace vinerow::controllers {

void MapWatch::look(Time now, const RowMeshIndex& map, const std::vector<RangeSensorModel>& sensors,
                    const Pose& X_MB, double reach_m, EstimatorEvents& events) {
  if (sensors.empty() || (has_looked_ && now < next_)) return;
  if (!has_looked_) last_wall_ = now;
  has_looked_ = true;
  next_ = now + kPeriod;
  const bool sees_wall =
      std::any_of(sensors.begin(), sensors.end(), [&](const RangeSensorModel& sensor) {
        return predict_range(map, X_MB, sensor, reach_m).has_value();
      });
  if (sees_wall) {
    last_wall_ = now;
    if (!is_without_) return;
    is_without_ = false;
    events.report_event(Event::Level::kInfo,
                        fmt::format("the map has walls within reach again at ({:.1f}, {:.1f})",
                                    X_MB.p.x(), X_MB.p.y()));
  } else if (!is_without_ && now - last_wall_ > kLong) {
    is_without_ = true;
    ++times_without_;
    events.report_event(
        Event::Level::kInfo,
        fmt::format("the map has had no wall within {:.1f} m of the range sensors for {:.0f} "
                    "s, now at ({:.1f}, {:.1f}): echoes are not used",
                    reach_m, kLong.s(), X_MB.p.x(), X_MB.p.y()));
  }
}

}  // namespace vinerow::controllers
