#pragma once
/// Monitor of whether the map has walls within reach of a vehicle's range sensors. Without walls,
/// echoes add no information and the estimate comes from fixes and inertial unit alone; the monitor
/// reports this.

#include <string>
#include <vector>

#include "controllers/estimation/parts/estimator_events.h"
#include "controllers/estimation/row_localisation/range_prediction.h"

namespace vinerow::controllers {

class MapWatch {
 public:
  static constexpr Duration kPeriod{200'000'000};  ///< between checks
  static constexpr Duration kLong{5'000'000'000};  ///< time without a wall that is reported

  /// Checks once per kPeriod. Reports if no sensor had a wall of the map within reach for kLong,
  /// and when one has a wall again. Does nothing without sensors.
  /// @param X_MB  estimated pose of the vehicle on the map @param reach_m  of the sensors
  void look(Time now, const RowMeshIndex& map, const std::vector<RangeSensorModel>& sensors,
            const Pose& X_MB, double reach_m, EstimatorEvents& events);
  /// Number of reports of missing walls.
  int times_without() const { return times_without_; }

 private:
  bool has_looked_ = false;
  bool is_without_ = false;
  Time next_;
  Time last_wall_;
  int times_without_ = 0;
};

}  // namespace vinerow::controllers
