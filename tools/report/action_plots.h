#pragma once
/// Plots of a vehicle's control actions, steering, wheel slip, use of limits and energy.

#include <vector>

#include "tools/report/line_plot.h"
#include "tools/report/track.h"

namespace vinerow::tools::report {

/// Plots whose signals exist, over the time of the track.
std::vector<LinePlot> action_plots(const VehicleLog& vehicle, const Track& track);

}  // namespace vinerow::tools::report
