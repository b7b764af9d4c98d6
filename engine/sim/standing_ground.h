#pragma once
/// The ground that things are set down on: terrain; where a place has none, obstacles, as in a
/// world whose files do not say what is ground. What stands on the ground is none of it.

#include <optional>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"

namespace vinerow {

class StandingGround {
 public:
  /// @param world,scene  outlive this object
  StandingGround(const WorldModel& world, const SceneQuery& scene);

  /// The highest ground at a place. @returns nothing where there is none
  std::optional<double> height_m(double x, double y) const;
  /// Whether only obstacles are there.
  bool takes_obstacles(double x, double y) const { return !terrain_m(x, y, kFromAbove_m); }
  /// Ground beside a place that a wheel could stand on: not a wall, a crown or a roof, which rise
  /// by more than 45 deg. @param here_m  height of the ground at the place  @param obstacles  the
  /// place takes them  @param beside_m  how far (x, y) is from the place
  std::optional<double> beside_m(double x, double y, double here_m, bool obstacles,
                                 double beside_m) const;

 private:
  static constexpr double kFromAbove_m = 2e4;  ///< higher than any ground
  std::optional<double> terrain_m(double x, double y, double z_from) const;

  const WorldModel& world_;
  const SceneQuery& scene_;
  bool has_terrain_mesh_ = false;
};

}  // namespace vinerow
