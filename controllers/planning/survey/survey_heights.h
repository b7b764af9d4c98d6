#pragma once
/// Heights of a flight along straight pieces above the terrain: straight ramps between as few
/// points as the accuracy allows (paper A, section 2: points are added until the ramp follows the
/// terrain; reference, section 2: within 2 m and 12 %).

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.h"

namespace vinerow::controllers {

/// Height of the ground in W at a place; nullopt if there is no ground.
using GroundHeight = std::function<std::optional<double>(const Eigen::Vector2d&)>;

/// Profile of the ground along a polyline, at equal steps on each of its pieces.
class GroundProfile {
 public:
  /// Beyond the terrain, the profile continues with the nearest height along the line. @returns the
  /// profile, or "there is no ground below any of it"
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
  int beyond_terrain() const { return beyond_; }  ///< number of samples without ground below

 private:
  std::vector<Sample> samples_;
  std::vector<int> at_point_;
  int beyond_ = 0;
};

/// Wanted heights at the profile's samples: the lowest heights that are at least `above_m` over the
/// ground and nowhere rise or fall faster than `max_slope`.
std::vector<double> make_wanted_heights(const GroundProfile& profile, double above_m,
                                        double max_slope);

/// Changes the wanted heights to start at start_m and climb or descend at max_slope until they
/// reach the former values. @returns distance along the line until then
double start_heights_at(const GroundProfile& profile, double start_m, double max_slope,
                        std::vector<double>& wanted_m);

/// Indices of the samples that become end points of ramps, ascending, with all points of the line
/// among them. Ramps connect the wanted heights at these samples and miss those between by at most
/// `error_m`. The result has the fewest points at the wanted height that do this, by dynamic
/// programming over the samples of each piece; among equally few, the evenest.
std::vector<int> split_ramps(const GroundProfile& profile, const std::vector<double>& wanted_m,
                             std::size_t point_count, double error_m);

}  // namespace vinerow::controllers
