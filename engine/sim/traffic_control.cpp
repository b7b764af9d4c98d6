#include "engine/sim/traffic_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"
#include "engine/core/error.h"

namespace vinerow {
namespace {

/// True if guidance or controller of a vehicle reads its authority.
bool honours_authority(const scenario::VehicleConfig& vehicle, const Registry& registry) {
  const auto reads = [&](PartKind kind, const std::optional<scenario::PartConfig>& part) {
    if (!part) return false;
    const std::vector<std::string>& names = registry.spec(kind, part->type).reads;
    return std::any_of(names.begin(), names.end(),
                       [](const std::string& name) { return name.starts_with("authority"); });
  };
  return reads(PartKind::kGuidance, vehicle.guidance) ||
         reads(PartKind::kController, vehicle.controller);
}

/// Largest speed between rows that look_ahead_m is made for. Chosen: no vehicle is faster there.
constexpr double kMaxRowSpeed_mps = 4.0;
/// Speed of a vehicle whose description has no top speed. Chosen.
constexpr double kUnknownSpeed_mps = 1.5;
/// Distance added to the stopping distance. Chosen.
constexpr double kStopMargin_m = 2.0;

TrafficVehicle describe(const VehicleRuntime& vehicle, double stop_before_m) {
  const VehicleDescription& description = vehicle.vehicle().description();
  TrafficVehicle result;
  result.name = vehicle.name();
  const double half_m = description.collision_half_extents_m.x();
  result.length_m = 2.0 * half_m;
  result.stop_before_m = stop_before_m + half_m;
  // Stopping distance v^2 / (2 a) at a gentle a = 0.5 m/s2, which is v^2, plus the margin.
  const std::optional<double>& speed_mps = description.max_speed_mps;
  const double v_mps = speed_mps ? std::min(*speed_mps, kMaxRowSpeed_mps) : kUnknownSpeed_mps;
  result.look_ahead_m = v_mps * v_mps + kStopMargin_m;
  result.use.flies = description.flies();
  return result;
}

}  // namespace

TrafficControl::TrafficControl(const RunContext& run,
                               const std::vector<std::unique_ptr<VehicleRuntime>>& vehicles,
                               std::function<void(VehicleRuntime&, const std::string&)> on_deadlock)
    : on_deadlock_(std::move(on_deadlock)) {
  const scenario::TrafficConfig& config = run.scenario.traffic;
  std::vector<TrafficVehicle> described;
  for (const std::string& name : config.vehicles) {
    for (std::size_t i = 0; i < vehicles.size(); ++i) {
      if (vehicles[i]->name() != name) continue;
      if (!honours_authority(run.scenario.vehicles[i], run.registry)) {
        throw ConfigError(fmt::format(
            "{}: traffic.reserve_alleys: neither guidance nor controller of '{}' reads the signal "
            "'authority', so it cannot wait for an alley",
            config.where.text(), name));
      }
      Lane lane;
      lane.vehicle = vehicles[i].get();
      lane.plan = run.bus.subscribe_optional<PlannedPath>(name + "/plan", "traffic");
      lane.follower = run.bus.subscribe_optional<FollowerState>(name + "/follower", "traffic");
      // A fixed-wing vehicle's "reference" has another type, but it does not share alleys.
      lane.reference =
          run.bus.subscribe_optional<ReferenceTrajectory>(name + "/reference", "traffic");
      lane.authority = run.bus.advertise<MovementAuthority>(name + "/authority", "traffic");
      described.push_back(describe(*vehicles[i], config.stop_before_m));
      lanes_.push_back(std::move(lane));
    }
  }
  if (run.world.rows->alleys.empty()) {
    throw ConfigError(
        fmt::format("{}: traffic.reserve_alleys: the world has no alleys", config.where.text()));
  }
  traffic_ = std::make_unique<AlleyTraffic>(run.world.rows->alleys, std::move(described));
}

double TrafficControl::distance_m(const Lane& lane) const {
  if (lane.follower.has_value()) return lane.follower.value().distance_m;
  return lane.reference.has_value() ? lane.reference.value().distance_m : 0.0;
}

void TrafficControl::follow(int i, Time now) {
  Lane& lane = lanes_[i];
  const bool works = lane.vehicle->at_work() && !lane.vehicle->crash();
  if (works && lane.plan.has_value() && lane.plan.is_newer_than(lane.plan_seen)) {
    traffic_->begin(i, now, lane.plan.value(), distance_m(lane));
    lane.works = true;
    lane.lost = false;
  }
  if (!lane.works) return;
  if (works) {
    traffic_->advance(i, now, distance_m(lane));
    return;
  }
  lane.works = false;
  lane.plan_seen = 0;
  traffic_->leave(i, lane.vehicle->stranded() ? AlleyTraffic::Leaving::kStaysThere
                                              : AlleyTraffic::Leaving::kGone);
}

void TrafficControl::step(Time now) {
  for (int i = 0; i < traffic_->vehicles(); ++i) follow(i, now);
  traffic_->serve();
  for (int i = 0; i < traffic_->vehicles(); ++i) {
    if (lanes_[i].works) lanes_[i].authority.write(now, traffic_->authority(i));
  }
  for (int i = 0; i < traffic_->vehicles(); ++i) {
    Lane& lane = lanes_[i];
    if (!lane.works || lane.lost) continue;
    const std::optional<std::string> deadlock = traffic_->deadlock(i);
    if (!deadlock) continue;
    lane.lost = true;
    on_deadlock_(*lane.vehicle, *deadlock);
  }
}

}  // namespace vinerow
