#pragma once
/// Plots of what estimators made of the sensors: error across and along the rows with what they
/// state of it.

#include <vector>

#include "engine/api/forward.h"
#include "tools/report/line_plot.h"
#include "tools/report/vehicle_log.h"

namespace vinerow::tools::report {

/// Estimate less truth across and along the nearest row (within 5 m, else the heading), with the
/// band of +-2 sigma that the estimator states; none where the estimate is the truth. As the metric
/// `estimation` judges it. @param world  null: the heading everywhere
std::vector<LinePlot> estimate_plots(const VehicleLog& vehicle, const WorldModel* world);

}  // namespace vinerow::tools::report
