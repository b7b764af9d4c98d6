#pragma once
/// Windows of simulated time in which something is different: an outage, jamming.

#include <string>
#include <string_view>
#include <vector>

#include "engine/api/parameters.h"
#include "engine/core/time.h"

namespace vinerow {

/// [begin, end)
struct TimeWindow {
  Time begin;
  Time end;
  bool contains(Time now) const { return now >= begin && now < end; }
};

/// `begin_s` and `end_s`, the fields of a list of windows. @param what  "the outage"
std::vector<ParameterSpec> time_window_fields(const std::string& what);

/// Of an entry with these fields. @param list  the parameter's name, for errors
/// @throws ConfigError if the window ends before it begins
TimeWindow read_time_window(const ParameterSet& entry, std::string_view list);

/// All windows of the group list `list`. @param part  whose they are, for errors
/// @throws ConfigError as above
std::vector<TimeWindow> read_time_windows(const ParameterSet& parameters, const std::string& list,
                                          const std::string& part);

bool is_in_any(const std::vector<TimeWindow>& windows, Time now);

}  // namespace vinerow
