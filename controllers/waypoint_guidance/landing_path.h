#pragma once
/// The way down to the ground as it lies: the glide of LandingSlope ends at the ground below the
/// flare's begin and keeps clear of what rises before; the flare is flown above the ground, not
/// above the height of the touchdown, so that the vehicle sinks onto a slope as softly as onto a
/// plain wherever it touches. Where no ground is known it is level at the touchdown's height.

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "controllers/waypoint_guidance/landing_slope.h"

namespace vinerow::controllers {

/// Height of the ground as the vehicle's map has it; nothing where it has none.
using GroundBelow = std::function<std::optional<double>(const Eigen::Vector2d&)>;

/// Where a landing comes from and goes to, in plan view.
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
  /// Allocates. @param ground  @param lift_m  of B's origin above it, lying on the ground there
  /// @pre the ground below the place is known
  LandingPath(const LandingSlope& slope, const LandingLine& line, const GroundBelow& ground,
              double lift_m);

  /// Of B's origin, like LandingSlope. No heap.
  HeightPoint at(double to_go_m) const { return pick(path_, to_go_m, slope_.at(to_go_m)); }
  /// Of B's origin where the vehicle lies on the ground.
  HeightPoint lying(double to_go_m) const {
    return pick(ground_, to_go_m, {slope_.touchdown_m(), 0.0});
  }
  bool knows_ground() const { return !path_.empty(); }
  /// The highest of the way to the touchdown. @pre knows_ground()
  double highest_m() const;
  /// Mean slope of the ground where the vehicle flares and slides, along the landing.
  double rise() const;
  /// The ground's steepest fall along the landing there, >= 0.
  double steepest_fall() const;

 private:
  static constexpr double kStep_m = 1.0;
  /// Beyond the touchdown, for what floats on and slides.
  static constexpr double kBeyond_m = 60.0;

  HeightPoint pick(const std::vector<double>& heights_m, double to_go_m, HeightPoint level) const;

  LandingSlope slope_;
  double length_m_ = 0.0;
  std::vector<double> ground_, path_;  // every kStep_m from the line's begin
};

}  // namespace vinerow::controllers
