#pragma once
/// Watches whether the map has walls where a vehicle's range sensors look. Without them echoes tell
/// nothing, and the estimate is that of fixes and inertial unit: people should know.

#include <string>
#include <vector>

#include "controllers/estimation/parts/estimator_news.h"
#include "controllers/estimation/row_localisation/range_prediction.h"

namespace vinerow::controllers {

class MapWatch {
 public:
  static constexpr Duration kPeriod{200'000'000};  ///< between looks
  static constexpr Duration kLong{5'000'000'000};  ///< so long without a wall is told

  /// Looks if it is time to, and tells when for kLong no sensor has a wall on the map within reach,
  /// and when one has again. No sensors: nothing is watched.
  /// @param X_MB  the vehicle on the map, as it is estimated  @param reach_m  of the sensors
  void look(Time now, const RowMeshIndex& map, const std::vector<RangeSensorModel>& sensors,
            const Pose& X_MB, double reach_m, EstimatorNews& news);
  /// Times that it was told that there are none.
  int times_without() const { return times_without_; }

 private:
  bool has_looked_ = false;
  bool is_without_ = false;
  Time next_;
  Time last_wall_;
  int times_without_ = 0;
};

}  // namespace vinerow::controllers
