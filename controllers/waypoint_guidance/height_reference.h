#pragma once
/// Height reference that follows the wanted height at a climb rate that the vehicle can fly,
/// without steps when the stage of the mission changes.

#include <algorithm>
#include <cmath>

namespace vinerow::controllers {

class HeightReference {
 public:
  void start(double height_m) {
    height_m_ = height_m;
    rate_mps_ = 0.0;
  }
  /// @param rate_mps  of the wanted height, fed forward
  /// @param min_mps, max_mps  of the rate
  void advance(double dt_s, double wanted_m, double rate_mps, double min_mps, double max_mps) {
    // The difference is not overshot at low rates of the guidance either.
    const double settle_s = std::max(kSettle_s, 2.0 * dt_s);
    rate_mps_ = std::clamp(rate_mps + (wanted_m - height_m_) / settle_s, min_mps, max_mps);
    height_m_ += dt_s * rate_mps_;
  }
  double height_m() const { return height_m_; }
  double rate_mps() const { return rate_mps_; }
  /// Climb angle of the path through the air.
  double climb_rad(double airspeed_mps) const {
    return std::asin(std::clamp(rate_mps_ / airspeed_mps, -0.9, 0.9));
  }

 private:
  static constexpr double kSettle_s = 1.0;
  double height_m_ = 0.0;
  double rate_mps_ = 0.0;
};

}  // namespace vinerow::controllers
