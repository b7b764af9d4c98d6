#pragma once
/// The ground below a parcel's points.

#include "engine/api/height_field.h"
#include "worlds/mapping/model/parcel_cloud.h"

namespace vinerow::mapping {

struct CloudTerrain {
  HeightField field;        ///< in W; a sample for every cell that the cloud's bounds touch
  double noise_m = 0.0;     ///< 1 sigma of ground points about the field
  double covered_m2 = 0.0;  ///< of cells that hold points
};

/// Ground at every sample from the points around it: the lowest heights that many points share,
/// about a coarse surface that follows the slope. Samples that stand out from what lies around them
/// by more than vegetation can hide (under a canopy, on a wall or a hedge) and samples without
/// points are filled in from their neighbours, then all are smoothed over about two cells. Points
/// below the ground (false matches) are outvoted. Cost: linear in the points, two passes.
/// @pre cloud not empty. @throws ConfigError where the bounds need more than 4 million cells (or
/// are beyond 6.25 km2), and where they hold less than a point in 4 m2 and are larger than a
/// hectare
CloudTerrain fit_terrain(const ParcelCloud& cloud, double cell_m);

/// Heights above a field at points given relative to an origin in W: the field's own triangles, in
/// the points' precision.
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
