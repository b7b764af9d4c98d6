#include "engine/live/entities.h"

#include <algorithm>

#include "engine/sim/simulation.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow::live {

void Entities::watch(const Simulation& simulation) {
  const std::lock_guard lock(mutex_);
  simulation_ = &simulation;
  names_.clear();
  truths_.clear();
  for (const auto& vehicle : simulation.vehicles()) names_.push_back(vehicle->name());
}

void Entities::on_instant(Time now) {
  // Only copies: this is part of every step, while questions are rare.
  const std::lock_guard lock(mutex_);
  stamp_ = now;
  truths_.resize(names_.size());
  for (std::size_t i = 0; i < truths_.size(); ++i) truths_[i] = simulation_->vehicles()[i]->truth();
}

std::vector<std::string> Entities::names() const {
  const std::lock_guard lock(mutex_);
  return names_;
}

std::optional<Entities::State> Entities::state(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end() || truths_.empty()) return std::nullopt;
  const Odometry& truth = truths_[static_cast<std::size_t>(found - names_.begin())];
  return State{stamp_, truth.X_WB, truth.X_WB.q * truth.v_WB_B, truth.X_WB.q * truth.w_WB_B};
}

}  // namespace vinerow::live
