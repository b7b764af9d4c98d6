#include "engine/sensors/time_window.h"

#include <fmt/format.h>

#include "engine/api/parameter_table.h"

namespace vinerow::sensors {
namespace {

std::string find_fault_in_window(const TimeWindowParams& p) {
  if (p.end_s >= p.begin_s) return "";
  return fmt::format("end_s = {} s, must be >= begin_s = {} s", p.end_s, p.begin_s);
}

}  // namespace

const ParameterTable<TimeWindowParams>& time_window_table() {
  using P = TimeWindowParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("begin_s", "s", &P::begin_s, between(0.0, 1e7), "start of the outage")
          .required()
          .number("end_s", "s", &P::end_s, between(0.0, 1e7), "end of the outage")
          .required()
          .rule(find_fault_in_window);
  return table;
}

TimeWindow TimeWindowParams::window() const {
  return {Time{duration_from_s(begin_s).ns}, Time{duration_from_s(end_s).ns}};
}

std::vector<TimeWindow> windows_of(const std::vector<TimeWindowParams>& params) {
  std::vector<TimeWindow> windows;
  for (const TimeWindowParams& window : params) windows.push_back(window.window());
  return windows;
}

bool is_in_any(const std::vector<TimeWindow>& windows, Time now) {
  for (const TimeWindow& window : windows) {
    if (window.contains(now)) return true;
  }
  return false;
}

}  // namespace vinerow::sensors
