#pragma once
/// Plots of what a vehicle's controller asked for: control actions, steering, wheel slip, the use
/// of limits, energy.

#include <vector>

#include "tools/report/line_plot.h"
#include "tools/report/track.h"

namespace vinerow::tools::report {

/// Those whose signals exist, over the time of the track.
std::vector<LinePlot> action_plots(const VehicleLog& vehicle, const Track& track);

}  // namespace vinerow::tools::report
