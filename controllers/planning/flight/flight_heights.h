#pragma once
/// Heights of a flight over the row map: at a fixed height above the terrain, and on the way home
/// above terrain and canopy (paper A, section 4.2; reference: the path home follows the terrain).

#include <optional>
#include <string>
#include <vector>

#include "controllers/parts/paths/path_curve.h"
#include "engine/api/forward.h"
#include "engine/api/scene_query.h"
#include "engine/core/result.h"

namespace vinerow::controllers {

/// Terrain and canopy of the map, as heights in W.
class FlightGround {
 public:
  /// References must outlive this. @param scene  null: the ground is flat at `flat_m`
  FlightGround(const RowMap& map, const SceneQuery* scene, double flat_m);

  /// Height of the ground; nullopt if the map has no ground there.
  std::optional<double> ground_m(const Eigen::Vector2d& p) const;
  /// Highest canopy top within `reach_m` of a point; nullopt if no row is that near.
  std::optional<double> canopy_top_m(const Eigen::Vector2d& p, double reach_m) const;
  /// Distance from a point to the side of the nearest canopy, seen from above, m, negative inside,
  /// with the index of its row. Row -1: the map has no rows.
  struct Nearest {
    double distance_m = 0.0;
    double centre_m = 0.0;  ///< to the row's centre line
    int row = -1;
  };
  Nearest find_nearest_row(const Eigen::Vector2d& p) const;
  const RowMap& map() const { return map_; }

 private:
  const RowMap& map_;
  const SceneQuery* scene_;
  double flat_m_;
};

/// Heights at equal distances along a path in the plane.
class HeightProfile {
 public:
  HeightProfile() = default;
  HeightProfile(double step_m, std::vector<double> heights_m)
      : step_m_(step_m), heights_m_(std::move(heights_m)) {}
  /// Linear between samples; beyond an end, the value at the end.
  double at(double distance_m) const;
  const std::vector<double>& samples_m() const { return heights_m_; }
  double step_m() const { return step_m_; }

 private:
  double step_m_ = 1.0;
  std::vector<double> heights_m_ = {0.0};
};

/// Profile of the ground below a path, every 5 cm. @returns "path leaves the ground: no ground at
/// (x, y)" if the ground ends
Result<HeightProfile> make_ground_profile(const Path& path, const FlightGround& ground);

/// Heights `above_m` over the ground, smoothed by two moving averages that reach `smooth_m`
/// together. Both ends keep their exact height.
HeightProfile make_row_profile(const HeightProfile& ground, double above_m, double smooth_m);

/// Heights at least `above_m` over the ground and over canopies within `reach_m`: the smoothed
/// ground, plus an upper bound of what rises above it, widened and smoothed over `smooth_m` to
/// either side, so that the clearance is nowhere less than above_m.
HeightProfile make_return_profile(const Path& path, const HeightProfile& ground_m,
                                  const FlightGround& ground, double above_m, double reach_m,
                                  double smooth_m);

}  // namespace vinerow::controllers
