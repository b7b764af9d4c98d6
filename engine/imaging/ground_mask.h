#pragma once
/// Grid of distances to rows and alleys, which determine bare soil, wheel tracks and grass.

#include <Eigen/Geometry>

#include "engine/api/forward.h"
#include "engine/imaging/pixels.h"

namespace vinerow::imaging {

struct GroundMask {
  static constexpr double kReach_m = 2.55;  ///< distances are stored up to here, in steps of 1 cm

  Eigen::Vector2d corner_W = {0, 0};
  Eigen::Vector2d size_m = {1, 1};
  Pixels pixels;  ///< R to the nearest row, G to the middle of the nearest alley,
                  ///< B 255 in an alley, fading beyond its ends; row 0 is south

  /// Distances at a position, m; kReach_m outside.
  double row_distance_m(double x, double y) const { return lookup(x, y, 0); }
  double alley_distance_m(double x, double y) const { return lookup(x, y, 1); }

 private:
  double lookup(double x, double y, int channel) const;
};

/// Sizes are powers of two up to 2048; without rows, a single pixel with maximum distances.
GroundMask make_ground_mask(const RowMap& rows);

}  // namespace vinerow::imaging
