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

/// Thresholds of fit_terrain(), all chosen.
struct CloudTerrainOptions {
  /// Cells of the coarse surface: wider than most row spacings, so that one holds a part of an
  /// alley.
  double coarse_cell_m = 5.0;
  /// Quantile of a coarse cell: above the false matches below the ground, below the vegetation.
  double coarse_share = 0.03;
  double low_share = 0.05;  ///< quantile from which a cell's lowest peak is sought
  /// Reach of the mean shift, 0.15 m in bins of 2 cm: the noise of the ground, not the canopy.
  double peak_reach_bins = 7.5;
  // Small objects are removed first, with a small step; then wide ones, with a larger step, because
  // over 5 m the ground itself bends.
  double small_reach_m = 2.0, small_step_m = 0.2;
  double wide_reach_m = 5.0, wide_step_m = 0.8;
  double filled_weight = 0.02;  ///< in smoothing, of a sample without ground, over a full one
  double full_points = 20.0;    ///< of a full sample: their mean is steady to a fifth of the noise
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
CloudTerrain fit_terrain(const ParcelCloud& cloud, double cell_m,
                         const CloudTerrainOptions& options = {});

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
