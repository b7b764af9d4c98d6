#include "engine/sensors/readings.h"

namespace vinerow::sensors {

const ParameterTable<ReadingParams>& reading_table() {
  using P = ReadingParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("delay_s", "s", &P::delay_s, between(0.0, 10.0),
                  "time between measurement and delivery, a multiple of the physics step")
          .number("dropout_share", "", &P::dropout_share, between(0.0, 1.0),
                  "share of the readings that are lost, each drawn independently")
          .groups("outages", &P::outages, time_window_table(), "time windows without a reading");
  return table;
}

}  // namespace vinerow::sensors
