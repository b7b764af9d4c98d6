#include "engine/live/entities.h"

#include "engine/sim/simulation.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow::live {

void Entities::watch(const Simulation& simulation) {
  const std::lock_guard lock(mutex_);
  simulation_ = &simulation;
  names_.clear();
  states_.clear();
  for (const auto& vehicle : simulation.vehicles()) names_.push_back(vehicle->name());
}

void Entities::on_instant(Time now) {
  // Uncontended, this costs some 20 ns.
  const std::lock_guard lock(mutex_);
  for (const auto& vehicle : simulation_->vehicles()) {
    const Odometry& truth = vehicle->truth();
    states_[vehicle->name()] = {now, truth.X_WB, truth.X_WB.q * truth.v_WB_B,
                                truth.X_WB.q * truth.w_WB_B};
  }
}

std::vector<std::string> Entities::names() const {
  const std::lock_guard lock(mutex_);
  return names_;
}

std::optional<Entities::State> Entities::state(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = states_.find(name);
  if (found == states_.end()) return std::nullopt;
  return found->second;
}

}  // namespace vinerow::live
