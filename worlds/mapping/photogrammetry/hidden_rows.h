#pragma once
/// Rows whose canopy no picture shows: a fault of a survey, as in the shadow of a cloud, or of a
/// vineyard whose vines were uprooted before the flight.

#include <Eigen/Core>
#include <vector>

#include "engine/api/forward.h"
#include "engine/math/polyline_index.h"
#include "worlds/mapping/model/parcel_cloud.h"

namespace vinerow::mapping {

class HiddenRows {
 public:
  /// @param hidden  PlantRow::id of each
  /// @throws ConfigError: the world has no such row
  HiddenRows(const WorldModel& world, const std::vector<int>& hidden);

  /// True if a point on a plant belongs to one of them: of all rows' lines theirs is the nearest.
  bool hide(const Eigen::Vector3d& p_W, PointClass truth) const;

 private:
  PolylineIndex rows_;        ///< lines of all rows; empty if none is hidden
  std::vector<bool> hidden_;  ///< of each line
};

}  // namespace vinerow::mapping
