#pragma once
/// What happened in the run, as its parts told it: warnings and errors on the first screen, all of
/// it in a chapter.

#include <string>
#include <vector>

#include "tools/report/run_folder.h"

namespace vinerow::tools::report {

struct RunEvent {
  double t_s = 0.0;
  std::string level;   ///< "info", "warning", "error"
  std::string source;  ///< "rover.controller"
  std::string text;
};

/// Of events.jsonl, else of the log, in the order of time. A line that is no event is passed over:
/// a run that was killed may have left half of one.
std::vector<RunEvent> read_events(const RunFolder& run);

/// Errors and warnings in a few lines, with a link to the chapter; "" where there is none.
std::string event_notice(const std::vector<RunEvent>& events);

/// The chapter: all events, and a box to see warnings and errors alone.
std::string event_table(const std::vector<RunEvent>& events);

}  // namespace vinerow::tools::report
