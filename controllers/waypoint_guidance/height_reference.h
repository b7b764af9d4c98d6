#pragma once
/// The height to hold: follows the plan's with a climb that the vehicle can fly, and without steps
/// where one way of flying takes over from another.

#include <algorithm>
#include <cmath>

namespace vinerow::controllers {

class HeightReference {
 public:
  void start(double height_m) {
    height_m_ = height_m;
    rate_mps_ = 0.0;
  }
  /// @param rate_mps  of the wanted height: flown ahead of any difference
  /// @param least_mps, most_mps  of the rate
  void advance(double dt_s, double wanted_m, double rate_mps, double least_mps, double most_mps) {
    // Also at low rates of the guidance the difference is not overshot.
    const double settle_s = std::max(kSettle_s, 2.0 * dt_s);
    rate_mps_ = std::clamp(rate_mps + (wanted_m - height_m_) / settle_s, least_mps, most_mps);
    height_m_ += dt_s * rate_mps_;
  }
  double height_m() const { return height_m_; }
  double rate_mps() const { return rate_mps_; }
  /// Of the path through the air.
  double climb_rad(double airspeed_mps) const {
    return std::asin(std::clamp(rate_mps_ / airspeed_mps, -0.9, 0.9));
  }

 private:
  static constexpr double kSettle_s = 1.0;
  double height_m_ = 0.0;
  double rate_mps_ = 0.0;
};

}  // namespace vinerow::controllers
