#pragma once
/// Wind shelter: share of the wind that is left between the rows of a block.
///
/// Inside, below the canopy's top h, wind decreases as exp(-a (1 - z / h)) from its value at the
/// top (Cionco, "A mathematical model for air flow in a vegetative canopy", J. Appl. Meteorol. 4,
/// 1965). Across the rows a is the world's attenuation; along them it is kAlongShare of it: the
/// rows channel the air along their direction, in which the block acts like a sparse canopy
/// (Miller, Stoll, Mahaffee, Neill, "Mean and turbulent flow statistics in a trellised agricultural
/// canopy", Boundary-Layer Meteorol. 165, 2017; the share is chosen).
///
/// Inside means within an alley or the strip of a row. Beyond that outline the shelter fades over
/// one canopy height (chosen) with a smooth step. It is stored on a grid, so that the cost of a
/// query does not depend on the world.

#include <Eigen/Core>
#include <vector>

#include "engine/api/forward.h"

namespace vinerow::vehicles {

/// Shelter above a point of the ground.
struct ShelterSpot {
  double inside = 0.0;  ///< 0 outside to 1 inside the block
  /// Direction of the rows at twice its angle from x, so that both senses agree; unit inside.
  Eigen::Vector2d axis = Eigen::Vector2d::Zero();
  double top_m = 0.0;  ///< of the canopy above the ground
};

/// Share of the wind that is left at a height.
struct ShelterFactors {
  double along = 1.0;   ///< along the rows
  double across = 1.0;  ///< also of the vertical wind

  /// @param axis  of the spot
  Eigen::Vector3d apply(const Eigen::Vector3d& wind_W, const Eigen::Vector2d& axis) const;
};

class WindShelter {
 public:
  static constexpr double kAlongShare = 0.5;

  /// @param attenuation  0: none
  WindShelter(const RowMap& rows, double attenuation);

  bool none() const { return spots_.empty(); }
  /// inside == 0 if there is no shelter.
  ShelterSpot spot(const Eigen::Vector2d& p_W) const;
  /// @param height_m  above the ground
  ShelterFactors factors(const ShelterSpot& spot, double height_m) const;

 private:
  struct Node {
    float inside, axis_x, axis_y, top_m;
  };
  const Node& node(int i, int j) const {
    return spots_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(i)];
  }

  double attenuation_;
  int columns_ = 0, rows_ = 0;
  double cell_m_ = 1.0;
  Eigen::Vector2d corner_W_ = {0, 0};
  std::vector<Node> spots_;  // columns * rows, x fastest
};

}  // namespace vinerow::vehicles
