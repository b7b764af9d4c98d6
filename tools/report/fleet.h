#pragma once
/// Report elements on all vehicles together: key numbers and separation.

#include <string>
#include <vector>

#include "tools/report/line_plot.h"
#include "tools/report/run_folder.h"
#include "tools/report/track.h"
#include "tools/report/vehicle_log.h"

namespace vinerow::tools::report {

/// Cards of the first screen. They contain nothing that depends on the machine: the page's script
/// copies the real-time factor from the element "real-time-factor".
std::string key_numbers(const RunFolder& run, const std::vector<VehicleLog>& vehicles);

/// Distance between the centres of each pair of vehicles while both are at work. Times in which one
/// waits for an alley that another occupies are shaded. Empty if no two work at the same time.
/// @param tracks  one per vehicle
LinePlot separation_plot(const std::vector<VehicleLog>& vehicles, const std::vector<Track>& tracks);

/// Smallest distance between the centres of two vehicles at the instants of the log, m; NaN for
/// fewer than two vehicles.
double min_separation_m(const std::vector<VehicleLog>& vehicles);

}  // namespace vinerow::tools::report
