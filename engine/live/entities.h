#pragma once
/// Vehicles of a run as other threads see them.

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/messages/motion.h"
#include "engine/sim/run_observer.h"

namespace vinerow {
class Simulation;
}

namespace vinerow::live {

class Entities final : public RunObserver {
 public:
  struct State {
    Time stamp;
    Pose X_WB;
    Eigen::Vector3d v_WB_W = {0, 0, 0};  ///< of the origin of B, in W, m/s
    Eigen::Vector3d w_WB_W = {0, 0, 0};  ///< rad/s
  };

  /// @param simulation  outlives this object's use as an observer
  void watch(const Simulation& simulation);
  /// Copies the true state of all vehicles.
  void on_instant(Time now) override;

  /// In the scenario's order.
  std::vector<std::string> names() const;
  /// State at the last instant. @returns nothing for an unknown name, or before the first instant
  std::optional<State> state(const std::string& name) const;

 private:
  const Simulation* simulation_ = nullptr;
  mutable std::mutex mutex_;
  std::vector<std::string> names_;
  Time stamp_;
  std::vector<Odometry> truths_;  ///< of `names_`; empty before the first instant
};

}  // namespace vinerow::live
