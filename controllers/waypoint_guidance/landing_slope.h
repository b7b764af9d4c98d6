#pragma once
/// Landing slope: a glide at a constant angle over ground, and a flare whose sink rate decays
/// exponentially with the distance flown.

#include <algorithm>
#include <cmath>

#include "controllers/waypoint_guidance/flight_legs.h"

namespace vinerow::controllers {

class LandingSlope {
 public:
  LandingSlope() = default;
  /// @param glide_rad  > 0  @param flare_m  height above the touchdown at which the flare starts, >
  /// 0
  LandingSlope(double touchdown_m, double glide_rad, double flare_m)
      : touchdown_m_(touchdown_m),
        slope_(std::tan(glide_rad)),
        flare_m_(flare_m),
        fade_m_(flare_m * (1.0 + kBelow) / slope_),
        flare_length_m_(fade_m_ * std::log((1.0 + kBelow) / kBelow)) {}

  double touchdown_m() const { return touchdown_m_; }  ///< z of W of B's origin
  double flare_m() const { return flare_m_; }
  /// Distance before the touchdown at which the slope is `above_m` above it.
  double length_m(double above_m) const {
    return flare_length_m_ + std::max(0.0, above_m - flare_m_) / slope_;
  }
  /// @param to_go_m  to the touchdown; negative: beyond it, where the reference continues slightly
  /// below the ground so that the vehicle does not float
  HeightPoint at(double to_go_m) const {
    const double flown_m = flare_length_m_ - to_go_m;
    if (flown_m < 0.0) return {touchdown_m_ + flare_m_ - slope_ * flown_m, -slope_};
    const double share = (1.0 + kBelow) * std::exp(-flown_m / fade_m_);
    return {touchdown_m_ + flare_m_ * (share - kBelow), -flare_m_ * share / fade_m_};
  }

 private:
  /// Depth of the end of the flare below the ground, in flare heights: the vehicle touches down
  /// with kBelow / (1 + kBelow) of the glide's sink rate.
  static constexpr double kBelow = 0.15;
  double touchdown_m_ = 0.0;
  double slope_ = 0.0875;
  double flare_m_ = 1.0;
  double fade_m_ = 13.0;
  double flare_length_m_ = 0.0;
};

}  // namespace vinerow::controllers
