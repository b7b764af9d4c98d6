#include "python/tasks/vehicle_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/sim/simulation.h"

namespace vinerow::tasks {

VehicleView::VehicleView(Session& session, const std::string& vehicle) {
  for (const auto& runtime : session.simulation().vehicles()) {
    if (runtime->name() == vehicle) runtime_ = runtime.get();
  }
  if (!runtime_) {
    const auto known = session.vehicles();
    throw ConfigError(fmt::format("the scenario has no vehicle '{}'{} (known: {})", vehicle,
                                  did_you_mean(vehicle, known), join(known)));
  }
  truth_ = session.signal<Odometry>(vehicle + "/truth");
  contacts_ = session.signal<NamedValues>(vehicle + "/contacts");
}

float seen_range_m(const SignalView<RangeSample>& sensor, float max_m) {
  if (!sensor.has_value() || !std::isfinite(sensor.value().range_m)) return max_m;
  return std::clamp(static_cast<float>(sensor.value().range_m), 0.0F, max_m);
}

}  // namespace vinerow::tasks
