#pragma once
/// The phases of a mission as bars over time, and as a table.

#include <string>
#include <vector>

#include "tools/report/run_folder.h"
#include "tools/report/track.h"

namespace vinerow::tools::report {

struct TimeBar {
  double from_s = 0.0, to_s = 0.0;
  std::string style;  ///< class of its colour
  std::string tip;    ///< tooltip
};

/// Row of bars.
struct TimeRow {
  std::string label;
  std::string note;  ///< text at the right, "succeeded"
  std::string note_style;
  std::vector<TimeBar> bars;
};

/// Bars over [0, end_s] as SVG, in two versions: names left of the bars for a wide page, above them
/// for a narrow one and if a name is long. The page's style shows one of them. "" without rows.
std::string time_line(const std::vector<TimeRow>& rows, double end_s, const std::string& label);

/// Rows for the phases of summary.json. A phase without simulated time gets a thin bar.
std::vector<TimeRow> phase_rows(const RunFolder& run);

/// Rows for a run without phases: the activities of every vehicle.
std::vector<TimeRow> activity_rows(const std::vector<VehicleLog>& vehicles,
                                   const std::vector<Track>& tracks);

/// Legend of the activities that occur.
std::string activity_legend(const std::vector<TimeRow>& rows);

/// Table of the phases: name, vehicles or job, state, start, end, reason, criteria met, product.
std::string phase_table(const RunFolder& run);

}  // namespace vinerow::tools::report
