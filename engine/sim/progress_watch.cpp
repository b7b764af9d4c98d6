#include "engine/sim/progress_watch.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/api/vehicle.h"

namespace vinerow {

ProgressWatch::ProgressWatch(const VehicleDescription& description) {
  if (!description.wheeled || description.flies()) return;
  radius_m_ = description.wheeled->wheel_radius_m;
  for (std::size_t i = 0; i < description.actuators.size(); ++i) {
    const std::string& name = description.actuators[i].name;
    if (name.starts_with("wheel_") && name.ends_with("_speed_radps")) {
      wheels_.push_back(static_cast<int>(i));
    }
  }
}

std::string ProgressWatch::update(Time now, const Eigen::Vector3d& p_W,
                                  const std::vector<double>& actuators, Duration dt) {
  if (wheels_.empty()) return {};
  const double moved_m = (p_W - from_W_).norm();
  if (!started_ || moved_m >= kMoved_m) {
    started_ = true;
    since_ = now;
    from_W_ = p_W;
    driven_m_ = 0.0;
    return {};
  }
  double sum_radps = 0.0;
  for (const int wheel : wheels_) sum_radps += actuators[static_cast<std::size_t>(wheel)];
  driven_m_ += radius_m_ * sum_radps / static_cast<double>(wheels_.size()) * dt.s();
  if (std::abs(driven_m_) < kDriven_m || (now - since_).s() < kPatience_s) return {};
  return fmt::format("its wheels were commanded to roll {:.1f} m in {:.1f} s and it moved {:.2f} m",
                     std::abs(driven_m_), (now - since_).s(), moved_m);
}

}  // namespace vinerow
