#pragma once
/// Heights of a flight along straight pieces above the terrain: straight ramps between as few
/// points as the wanted accuracy allows (paper A, section 2: points are added until the ramp
/// follows the terrain; reference, section 2: within 2 m and 12 %).

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.h"

namespace vinerow::controllers {

/// Height of the ground in W at a place; nullopt where there is none.
using GroundHeight = std::function<std::optional<double>(const Eigen::Vector2d&)>;

/// The ground along a polyline, at even steps of each of its pieces.
class GroundProfile {
 public:
  /// Where the terrain has ended, its nearest height along the line goes on.
  /// @returns "there is no ground below any of it"
  static Result<GroundProfile> make(const std::vector<Eigen::Vector2d>& line,
                                    const GroundHeight& ground);

  struct Sample {
    double distance_m = 0.0;  ///< along the line
    double ground_m = 0.0;
    Eigen::Vector2d p_W = {0, 0};
  };
  const std::vector<Sample>& samples() const { return samples_; }
  /// Index of the sample at a point of the line.
  int at_point(std::size_t point) const { return at_point_[point]; }
  double length_m() const { return samples_.back().distance_m; }
  int beyond_terrain() const { return beyond_; }  ///< samples without ground of their own

 private:
  std::vector<Sample> samples_;
  std::vector<int> at_point_;
  int beyond_ = 0;
};

/// Wanted heights at the profile's samples: `above_m` over the ground, or more where the ground is
/// steeper than `max_slope`: the lowest heights that stay above and nowhere rise or fall faster.
std::vector<double> make_wanted_heights(const GroundProfile& profile, double above_m,
                                        double max_slope);

/// As wanted, but beginning at start_m: straight up or down at max_slope until there.
/// @returns how far along the line it takes
double begin_heights_at(const GroundProfile& profile, double start_m, double max_slope,
                        std::vector<double>& wanted_m);

/// Samples to be points of the ramps, ascending, all points of the line among them. Ramps join the
/// wanted heights at them and miss those between by at most `error_m`. The fewest that do this with
/// points at the wanted height, by dynamic programming over the samples of each piece; of equally
/// few the evenest.
std::vector<int> split_ramps(const GroundProfile& profile, const std::vector<double>& wanted_m,
                             std::size_t point_count, double error_m);

}  // namespace vinerow::controllers
