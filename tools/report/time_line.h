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
  std::string tip;    ///< shown while the pointer rests on it
};

/// One line of bars.
struct TimeRow {
  std::string label;
  std::string note;  ///< at the right, "succeeded"
  std::string note_style;
  std::vector<TimeBar> bars;
};

/// Bars over [0, end_s] as SVG, twice: for a wide page with names beside the bars, for a narrow one
/// above them; the page's style shows one. Nothing without rows.
std::string time_line(const std::vector<TimeRow>& rows, double end_s, const std::string& label);

/// The phases of summary.json. A bar of a phase that took no simulated time is a sliver.
std::vector<TimeRow> phase_rows(const RunFolder& run);

/// Of a run without phases: what every vehicle did when.
std::vector<TimeRow> activity_rows(const std::vector<VehicleLog>& vehicles,
                                   const std::vector<Track>& tracks);

/// What the colours of activities mean, those that occur.
std::string activity_legend(const std::vector<TimeRow>& rows);

/// Name, what works in it, state, begin, end, reason, criteria met.
std::string phase_table(const RunFolder& run);

}  // namespace vinerow::tools::report
