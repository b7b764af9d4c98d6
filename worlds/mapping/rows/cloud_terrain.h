#pragma once
/// Terrain below the points of a parcel.

#include "engine/api/height_field.h"
#include "worlds/mapping/model/parcel_cloud.h"

namespace vinerow::mapping {

struct CloudTerrain {
  HeightField field;        ///< in W; one sample for every cell that the cloud's bounds touch
  double noise_m = 0.0;     ///< 1 sigma of ground points about the field
  double covered_m2 = 0.0;  ///< area of the cells in which ground was found
};

/// Fits the ground to a cloud.
///
/// The height of a sample is the lowest height that many of its points share, relative to a coarse
/// surface that follows the slope. Samples that rise abruptly above the lower envelope of their
/// neighbours (canopy, walls, hedges) and samples without points are filled in from their
/// neighbours. Then all samples are smoothed over about two cells. Points below the ground (false
/// matches) are too few to matter. Cost: linear in the points, two passes.
/// @pre the cloud is not empty
/// @throws ConfigError if the bounds need more than 4 million cells or exceed 6.25 km2, and if they
/// exceed one hectare with less than one point in 4 m2
CloudTerrain fit_terrain(const ParcelCloud& cloud, double cell_m);

/// Heights above a field, of points relative to an origin in W. Interpolates on the field's
/// triangles, in single precision.
class HeightAbove {
 public:
  HeightAbove(const HeightField& field, const Eigen::Vector3d& origin_W);
  float operator()(const Eigen::Vector3f& p) const;

 private:
  const HeightField& field_;
  float corner_x_, corner_y_, per_cell_;
  double origin_z_;
};

}  // namespace vinerow::mapping
