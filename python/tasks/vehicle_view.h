#pragma once
/// What every task reads of its vehicle.

#include "engine/api/messages.h"
#include "engine/api/vehicle.h"
#include "engine/sim/session.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow::tasks {

/// Signals and description of one vehicle of a session.
class VehicleView {
 public:
  VehicleView() = default;
  /// @throws ConfigError on an unknown vehicle
  VehicleView(Session& session, const std::string& vehicle);

  const VehicleDescription& description() const { return runtime_->vehicle().description(); }
  const VehicleRuntime& runtime() const { return *runtime_; }
  const Pose& pose() const { return truth_.value().X_WB; }
  const Odometry& truth() const { return truth_.value(); }
  /// Its hull touches something, or did since the start, or it crashed.
  bool has_touched() const {
    return (contacts_.has_value() && contacts_.value().values[0] > 0.0) || runtime_->crash();
  }

 private:
  const VehicleRuntime* runtime_ = nullptr;  ///< valid until the session's next reset
  SignalView<Odometry> truth_;
  SignalView<NamedValues> contacts_;
};

/// Range of the sensor, or the largest one if it sees nothing, m.
float seen_range_m(const SignalView<RangeSample>& sensor, float max_m);

}  // namespace vinerow::tasks
