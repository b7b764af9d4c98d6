#pragma once
/// Photogrammetry model: the point cloud that dense matching makes from a survey's pictures.
///
/// Model. A dense matcher uses each picture in turn as the reference, finds depths for its pixels
/// in neighbouring pictures, and fuses the depth maps, which keeps about one point for the ground
/// area of each pixel. In this model the ground is divided into cells of one point each (density;
/// by default a pixel of the mean ground sampling distance). One of the pictures that show a cell,
/// with equal probability, aims one ray at a random point in it. The first hit of that ray (leaves,
/// a post, the ground) is the candidate. Steep and lower sides of the canopy get points only from
/// pictures that see them, and few per area; on flat open ground the density is exact.
///
/// A candidate becomes a point if `min_views` pictures see it: it is within the picture, the ray
/// from the surface to the camera is free, and it leaves the surface at most `max_incidence_rad`
/// off its normal. The reference is one of them. The others are its partners by angle, nearest
/// first, up to `max_views` in all (matchers too use a handful of neighbours), and at least one of
/// them must differ by `min_baseline_rad` in direction. Ground behind vines, undersides and the
/// inner canopy are missing because no pictures show them.
///
/// The error of a point is drawn from the covariance of forward intersection with `match_px` of
/// error in each picture (triangulation.h), for the pictures that see it. Errors of neighbouring
/// points are independent. They share the errors of orientation and calibration: the similarity of
/// georeference.h. Smoothing and gross mismatches are not modelled, and a canopy is the world's
/// closed hull, not single leaves.
///
/// Cost: about 2.5 us per point and core. Memory does not grow with the number of points.

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"
#include "engine/api/survey_camera.h"
#include "engine/math/angles.h"
#include "worlds/mapping/photogrammetry/cloud_extent.h"
#include "worlds/mapping/photogrammetry/georeference.h"
#include "worlds/mapping/photogrammetry/sampled_point.h"

namespace vinerow::mapping {

struct PhotogrammetryOptions {
  std::optional<double> density_per_m2;           ///< on the ground; absent: 1 / GSD^2
  double match_px = 0.5;                          ///< 1 sigma in u and in v, of each picture
  int min_views = 3;                              ///< >= 2
  int max_views = 6;                              ///< used for a point, >= min_views
  double max_incidence_rad = rad_from_deg(80.0);  ///< off the surface's normal
  double min_baseline_rad = rad_from_deg(3.0);    ///< between the reference's ray and another
  std::vector<int> missing_rows;  ///< PlantRow::id of rows whose canopy no picture shows
  GeoreferenceOptions georeference;
  std::uint64_t seed = 1;
};

/// Sums over all points of a cloud.
struct CloudTally {
  std::int64_t points = 0, ground_points = 0, canopy_points = 0;
  double views = 0.0;                                         ///< sum
  double horizontal_error2_m2 = 0.0, height_error2_m2 = 0.0;  ///< sums of squares
  std::int64_t aims = 0;    ///< rays of pictures; of uniform sampling: candidates
  std::int64_t unseen = 0;  ///< candidates that too few pictures see
  std::int64_t thin = 0;    ///< candidates whose pictures are too close together
  std::int64_t outliers = 0;
  std::int64_t missing = 0;  ///< of rows whose canopy no picture shows

  void add(const CloudTally& other);
  double mean_views() const;
  double horizontal_rms_m() const;  ///< of both coordinates together
  double height_rms_m() const;
};

struct PhotogrammetryReport {
  CloudTally tally;
  double gsd_m = 0.0;           ///< mean of the pictures that may show the area
  double density_per_m2 = 0.0;  ///< as requested
  int pictures = 0;             ///< that may show the area
};

/// @throws ConfigError: out of range
void check_options(const PhotogrammetryOptions& options);

/// @param poses  X_WS of each picture; those whose axis meets no ground are left out
/// @param reference  similarity of the block as a whole
/// @returns counts; there are no points without ground or pictures within the area
/// @throws ConfigError: options out of range, no picture shows the area, a density as CloudTiles, a
/// missing row that the world does not have
PhotogrammetryReport sample_photogrammetry(const SceneQuery& scene, const WorldModel& world,
                                           const SurveyCamera& camera,
                                           const std::vector<Pose>& poses, const SurveyArea& area,
                                           const PhotogrammetryOptions& options,
                                           const CloudSink& sink,
                                           const Georeference& reference = {});

}  // namespace vinerow::mapping
