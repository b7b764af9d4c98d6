#pragma once
/// Events of a run: warnings and errors on the first screen, all events in a chapter.

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

/// Events from events.jsonl, or from the log if it is absent, in order of time. Skips lines that
/// are not events: a killed run may leave half a line.
std::vector<RunEvent> read_events(const RunFolder& run);

/// Errors and warnings in a few lines, with a link to the chapter; "" without any.
std::string event_notice(const std::vector<RunEvent>& events);

/// The chapter: all events, with a check box that hides all but warnings and errors.
std::string event_table(const std::vector<RunEvent>& events);

}  // namespace vinerow::tools::report
