#include "engine/sensors/readings.h"

namespace vinerow {

std::vector<ParameterSpec> reading_parameters() {
  return {number_parameter("delay_s", "s", 0.0, 0.0, 10.0,
                           "time between measurement and delivery, a multiple of the physics step"),
          number_parameter("dropout_share", "", 0.0, 0.0, 1.0,
                           "share of the readings that never arrive, drawn one by one"),
          group_list_parameter("outages", time_window_fields("the outage"),
                               "time windows without a reading")};
}

std::vector<ParameterSpec> join_parameters(
    std::initializer_list<std::vector<ParameterSpec>> lists) {
  std::vector<ParameterSpec> all;
  for (const std::vector<ParameterSpec>& list : lists) {
    all.insert(all.end(), list.begin(), list.end());
  }
  return all;
}

}  // namespace vinerow
