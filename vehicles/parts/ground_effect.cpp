#include "vehicles/parts/ground_effect.h"

#include <algorithm>
#include <cmath>

namespace vinerow::vehicles {

GroundEffect::GroundEffect(GroundEffectModel model, double rotor_radius_m, double arm_m,
                           double body_lift)
    : model_(model),
      radius_m_(rotor_radius_m),
      arm_m_(arm_m),
      body_lift_(body_lift),
      reach_m_(model == GroundEffectModel::kNone ? 0.0 : kReachRadii * rotor_radius_m) {}

double GroundEffect::thrust_ratio(double height_m, double facing) const {
  if (facing <= 0.0 || height_m >= reach_m_) return 1.0;
  const double z = std::max(height_m, 0.5 * radius_m_), r2 = radius_m_ * radius_m_;
  double wake = r2 / (16.0 * z * z);
  if (model_ == GroundEffectModel::kMultirotor) {
    const auto images = [z](double distance2) {
      const double slant2 = distance2 + 4.0 * z * z;
      return z / (slant2 * std::sqrt(slant2));
    };
    // Square: d^2 = 2 arm^2; diagonal: b^2 = 4 arm^2, which is also 2 d^2.
    const double adjacent = images(2.0 * arm_m_ * arm_m_), opposite = images(4.0 * arm_m_ * arm_m_);
    wake += r2 * (adjacent + (0.5 + 2.0 * body_lift_) * opposite);
  }
  wake *= facing * std::min(1.0, 4.0 * (1.0 - height_m / reach_m_));
  return 1.0 / std::max(1.0 - wake, 1.0 / kMaxRatio);
}

}  // namespace vinerow::vehicles
