#pragma once
/// Plots of estimation errors across and along the rows, with the stated uncertainty.

#include <vector>

#include "engine/api/forward.h"
#include "tools/report/line_plot.h"
#include "tools/report/vehicle_log.h"

namespace vinerow::tools::report {

/// Plots of estimate minus truth across and along the nearest row (the heading if none is within
/// 5 m), as in the metric `estimation`, with the band of +-2 sigma that the estimator states. Empty
/// if the estimate is the truth. @param world  null: the heading everywhere
std::vector<LinePlot> estimate_plots(const VehicleLog& vehicle, const WorldModel* world);

}  // namespace vinerow::tools::report
