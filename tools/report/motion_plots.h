#pragma once
/// Plots of a vehicle's motion: height, speed, heading, bank, and distance from the plan.

#include <vector>

#include "tools/report/line_plot.h"
#include "tools/report/run_folder.h"
#include "tools/report/track.h"

namespace vinerow::tools::report {

/// Plots whose signals exist. Their limits come from the run's criteria on the same quantity.
std::vector<LinePlot> motion_plots(const RunFolder& run, const VehicleLog& vehicle,
                                   const Track& track);

}  // namespace vinerow::tools::report
