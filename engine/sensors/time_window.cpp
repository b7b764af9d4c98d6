#include "engine/sensors/time_window.h"

#include <fmt/format.h>

#include "engine/core/error.h"

namespace vinerow {

std::vector<ParameterSpec> time_window_fields(const std::string& what) {
  return {required(number_parameter("begin_s", "s", 0.0, 0.0, 1e7, "start of " + what)),
          required(number_parameter("end_s", "s", 0.0, 0.0, 1e7, "end of " + what))};
}

TimeWindow read_time_window(const ParameterSet& entry, std::string_view list) {
  const double begin_s = entry.number("begin_s"), end_s = entry.number("end_s");
  if (end_s < begin_s) {
    throw ConfigError(
        fmt::format("{}: end_s = {} s, must be >= begin_s = {} s", list, end_s, begin_s));
  }
  return {Time{duration_from_s(begin_s).ns}, Time{duration_from_s(end_s).ns}};
}

std::vector<TimeWindow> read_time_windows(const ParameterSet& parameters, const std::string& list,
                                          const std::string& part) {
  std::vector<TimeWindow> windows;
  for (const ParameterSet& entry : parameters.groups(list)) {
    windows.push_back(read_time_window(entry, part + ": " + list));
  }
  return windows;
}

bool is_in_any(const std::vector<TimeWindow>& windows, Time now) {
  for (const TimeWindow& window : windows) {
    if (window.contains(now)) return true;
  }
  return false;
}

}  // namespace vinerow
