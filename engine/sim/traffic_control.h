#pragma once
/// Connection of the alley reservation (alley_traffic.h) to a run: reads the plans and distances
/// of the vehicles that share alleys and writes each vehicle's movement authority.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/messages/flight.h"
#include "engine/sim/alley_traffic.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow {

class TrafficControl {
 public:
  /// Rate at which authorities are computed.
  static constexpr double kRate_Hz = 20.0;

  /// @param vehicles  of the run, in its order; outlive this object
  /// @param on_deadlock  called once for every vehicle that will wait forever, with the reason
  /// @throws ConfigError if a vehicle's parts do not read the signal "authority", or the world has
  ///   no alleys
  TrafficControl(
      const RunContext& run, const std::vector<std::unique_ptr<VehicleRuntime>>& vehicles,
      std::function<void(VehicleRuntime& vehicle, const std::string& reason)> on_deadlock);

  /// One tick, in the stage kPlan.
  void step(Time now);

 private:
  struct Lane {
    VehicleRuntime* vehicle;
    SignalReader<PlannedPath> plan;
    SignalReader<FollowerState> follower;
    SignalReader<ReferenceTrajectory> reference;
    SignalWriter<MovementAuthority> authority;
    std::uint64_t plan_seen = 0;
    bool works = false;
    bool lost = false;  ///< its deadlock has been reported
  };
  void follow(int i, Time now);
  double distance_m(const Lane& lane) const;

  std::vector<Lane> lanes_;
  std::unique_ptr<AlleyTraffic> traffic_;
  std::function<void(VehicleRuntime&, const std::string&)> on_deadlock_;
};

}  // namespace vinerow
