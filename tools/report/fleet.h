#pragma once
/// What concerns all vehicles together: key numbers, and how near they come to each other.

#include <string>
#include <vector>

#include "tools/report/line_plot.h"
#include "tools/report/run_folder.h"
#include "tools/report/track.h"
#include "tools/report/vehicle_log.h"

namespace vinerow::tools::report {

/// The cards of the first screen. Without what depends on the machine: the page's script takes the
/// real-time factor from the element "real-time-factor".
std::string key_numbers(const RunFolder& run, const std::vector<VehicleLog>& vehicles);

/// Distance between the middles of every two vehicles while both are at work, with the stretches in
/// which one waits for an alley that the other has; empty where no two are.
/// @param tracks  one of each vehicle
LinePlot separation_plot(const std::vector<VehicleLog>& vehicles, const std::vector<Track>& tracks);

/// Least distance between the middles of two vehicles at the instants of the log, m; NaN for fewer
/// than two.
double least_separation_m(const std::vector<VehicleLog>& vehicles);

}  // namespace vinerow::tools::report
