#pragma once
/// Heights of a flight over the row map: at a fixed height above the terrain, and home above
/// terrain and canopy (paper A, section 4.2; reference: the way home follows the terrain).

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
  /// References must outlive this. @param scene  may be null: the ground is flat at `flat_m`
  FlightGround(const RowMap& map, const SceneQuery* scene, double flat_m);

  /// nullopt where the map has no ground.
  std::optional<double> ground_m(const Eigen::Vector2d& p) const;
  /// Highest canopy top within `reach_m` of a point; nullopt where no row is so near.
  std::optional<double> canopy_top_m(const Eigen::Vector2d& p, double reach_m) const;
  /// Distance from a point to the nearest canopy's side, seen from above, m, negative inside; with
  /// the row's index. Row -1: there are no rows.
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

/// Heights at even distances along a way in the plane.
class HeightProfile {
 public:
  HeightProfile() = default;
  HeightProfile(double step_m, std::vector<double> heights_m)
      : step_m_(step_m), heights_m_(std::move(heights_m)) {}
  /// Between samples straight; beyond the ends the end's.
  double at(double distance_m) const;
  const std::vector<double>& samples_m() const { return heights_m_; }
  double step_m() const { return step_m_; }

 private:
  double step_m_ = 1.0;
  std::vector<double> heights_m_ = {0.0};
};

/// The ground below a way, every 5 cm. @returns "... leaves the ground: there is none at (x, y)"
Result<HeightProfile> make_ground_profile(const Path& way, const FlightGround& ground);

/// `above_m` over the ground, smoothed by two moving averages that reach `smooth_m` together; at
/// the ends not smoothed away.
HeightProfile make_row_profile(const HeightProfile& ground, double above_m, double smooth_m);

/// At least `above_m` over the ground and over canopies within `reach_m`: the smoothed ground, and
/// what sticks out of that, widened and smoothed from above over `smooth_m` to either side, so that
/// nothing comes nearer than above_m.
HeightProfile make_return_profile(const Path& way, const HeightProfile& ground_m,
                                  const FlightGround& ground, double above_m, double reach_m,
                                  double smooth_m);

}  // namespace vinerow::controllers
