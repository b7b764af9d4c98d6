#pragma once
/// The point cloud that dense matching makes of a survey's pictures of a world.
///
/// Model. A dense matcher takes each picture in turn as the reference, finds a depth for its
/// pixels in the neighbouring pictures, and fuses the depth maps, which keeps about one point for
/// each pixel's worth of ground. So here: the ground is cut into cells of one point each (density;
/// by default a pixel of the mean ground sampling distance), each cell is aimed at once, at a
/// random place in it, by one of the pictures that show it, all with the same chance. What the
/// aiming ray meets first - leaves, a post, the ground - is the candidate. Steep and lower sides of
/// the canopy get points only from pictures that look at them, and few per area; over flat open
/// ground the density is exact.
///
/// A candidate becomes a point if `min_views` pictures see it: it is within the picture, the ray
/// from the surface to the camera is free, and leaves the surface at most `max_incidence_rad` off
/// its normal. The reference is one of them; the others are its partners by angle, nearest first,
/// up to `max_views` in all (matchers too work on a handful of neighbours), and at least one of
/// them must look from `min_baseline_rad` elsewhere. Ground behind vines, undersides and the inner
/// canopy are missing because no such pictures are.
///
/// Its error is drawn from the covariance of forward intersection with `match_px` of error in each
/// picture (triangulation.h), for the very pictures that see it. Errors of neighbouring points are
/// independent. What orientation and calibration put wrong they have in common: the similarity of
/// georeference.h. Smoothing and gross mismatches are not modelled, a canopy is the world's closed
/// hull and not single leaves.
///
/// Cost: about 2.5 us a point and core. Memory does not grow with the number of points.

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
  std::optional<double> density_per_m2;           ///< wanted on the ground; absent: 1 / GSD^2
  double match_px = 0.5;                          ///< 1 sigma in u and in v, of each picture
  int min_views = 3;                              ///< >= 2
  int max_views = 6;                              ///< that fix a point, >= min_views
  double max_incidence_rad = rad_from_deg(80.0);  ///< off the surface's normal
  double min_baseline_rad = rad_from_deg(3.0);    ///< between the reference's ray and some other
  std::vector<int> missing_rows;                  ///< PlantRow::id; no picture shows their canopy
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
  double density_per_m2 = 0.0;  ///< as it was wanted
  int pictures = 0;             ///< that may show the area
};

/// @throws ConfigError: out of range
void check_options(const PhotogrammetryOptions& options);

/// @param poses  X_WS of each picture; those whose axis meets no ground are left out
/// @param reference  where the block as a whole ends up
/// @returns what was made; no points where there is no ground or no picture within the area
/// @throws ConfigError: options out of range, no picture shows the area, a density as CloudTiles, a
/// missing row that the world does not have
PhotogrammetryReport sample_photogrammetry(const SceneQuery& scene, const WorldModel& world,
                                           const SurveyCamera& camera,
                                           const std::vector<Pose>& poses, const SurveyArea& area,
                                           const PhotogrammetryOptions& options,
                                           const CloudSink& sink,
                                           const Georeference& reference = {});

}  // namespace vinerow::mapping
