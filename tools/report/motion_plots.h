#pragma once
/// Plots of how a vehicle moved: height, speed, heading, bank, and its distance from the plan.

#include <vector>

#include "tools/report/line_plot.h"
#include "tools/report/run_folder.h"
#include "tools/report/track.h"

namespace vinerow::tools::report {

/// Those whose signals exist. Limits are those of the run's criteria on the same quantity.
std::vector<LinePlot> motion_plots(const RunFolder& run, const VehicleLog& vehicle,
                                   const Track& track);

}  // namespace vinerow::tools::report
