#pragma once
/// Windows of simulated time for outages and jamming.

#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "engine/core/time.h"

namespace vinerow::sensors {

/// [begin, end)
struct TimeWindow {
  Time begin;
  Time end;
  bool contains(Time now) const { return now >= begin && now < end; }
};

/// Parameters of a window.
struct TimeWindowParams {
  double begin_s = 0.0;
  double end_s = 0.0;  ///< >= begin_s

  TimeWindow window() const;
};

/// `begin_s` and `end_s`, described as an outage.
const ParameterTable<TimeWindowParams>& time_window_table();

std::vector<TimeWindow> windows_of(const std::vector<TimeWindowParams>& params);

bool is_in_any(const std::vector<TimeWindow>& windows, Time now);

}  // namespace vinerow::sensors
