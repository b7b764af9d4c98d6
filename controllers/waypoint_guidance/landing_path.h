#pragma once
/// Path of a landing above uneven ground. The glide of LandingSlope ends at the ground below the
/// start of the flare and keeps clear of obstacles of the terrain before it. The flare is relative
/// to the ground, not to the height of the touchdown, so that the vehicle touches a slope as softly
/// as a plain at any place. If no ground is known it is level at the touchdown's height.

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "controllers/waypoint_guidance/landing_slope.h"

namespace vinerow::controllers {

/// Height of the ground on the vehicle's map; nullopt if the map has no height there.
using GroundBelow = std::function<std::optional<double>(const Eigen::Vector2d&)>;

/// Line of a landing in plan view.
struct LandingLine {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< of the touchdown
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  double length_m = 0.0;  ///< before the place
};

class LandingPath {
 public:
  LandingPath() = default;
  /// Level ground. @param slope  with the touchdown's height
  explicit LandingPath(const LandingSlope& slope) : slope_(slope) {}
  /// Allocates. @param ground  @param lift_m  of B's origin above it, resting on the ground there
  /// @pre the ground below the place is known
  LandingPath(const LandingSlope& slope, const LandingLine& line, const GroundBelow& ground,
              double lift_m);

  /// Of B's origin, like LandingSlope. No heap.
  HeightPoint at(double to_go_m) const { return pick(path_, to_go_m, slope_.at(to_go_m)); }
  /// Of B's origin if the vehicle rests on the ground.
  HeightPoint lying(double to_go_m) const {
    return pick(ground_, to_go_m, {slope_.touchdown_m(), 0.0});
  }
  bool knows_ground() const { return !path_.empty(); }
  /// The highest point of the path to the touchdown. @pre knows_ground()
  double highest_m() const;
  /// Mean slope of the ground in the range of flare and slide, along the landing.
  double rise() const;
  /// Steepest fall of the ground along the landing there, >= 0.
  double steepest_fall() const;

 private:
  static constexpr double kStep_m = 1.0;
  /// Beyond the touchdown, for a vehicle that floats and slides.
  static constexpr double kBeyond_m = 60.0;

  HeightPoint pick(const std::vector<double>& heights_m, double to_go_m, HeightPoint level) const;

  LandingSlope slope_;
  double length_m_ = 0.0;
  std::vector<double> ground_, path_;  // every kStep_m from the line's start
};

}  // namespace vinerow::controllers
