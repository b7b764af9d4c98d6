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

void add_reading_parameters(std::vector<ParameterSpec>& parameters) {
  for (ParameterSpec& parameter : reading_parameters()) parameters.push_back(std::move(parameter));
}

}  // namespace vinerow
