#pragma once
/// Truth about the parcel of a synthetic cloud, in a file next to the cloud. Tests and comparisons
/// read it, but never the mapping.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"
#include "engine/math/geo_origin.h"
#include "engine/math/polygon.h"

namespace vinerow::mapping {

/// Truth about one row. Lengths in m; names as in MappedRowFigures.
struct RowTruth {
  int row = 0;
  std::vector<Eigen::Vector3d> line_W;                      ///< of the plants, on the ground
  Eigen::Vector3d first_W = {0, 0, 0}, last_W = {0, 0, 0};  ///< the canopy's ends, on the ground
  double length_m = 0.0;        ///< between them, along the line; 0: no canopy on it
  double bearing_deg = 0.0;     ///< first to last, clockwise from north
  double spacing_m = 0.0;       ///< mean distance to the next row's line; 0: the last row
  double canopy_base_m = 0.0;   ///< lowest, above the ground on the line, mean over the row
  double canopy_top_m = 0.0;    ///< highest, likewise
  double canopy_width_m = 0.0;  ///< of cross-sections, likewise
  double volume_m3 = 0.0;
  /// Gaps in the canopy on the line longer than 0.5 m, from and to along the line, from first_W.
  std::vector<std::pair<double, double>> gaps_m;
};

/// Record of how the cloud was made.
struct CloudSampling {
  std::string method;  ///< "photogrammetry" or "uniform"
  std::string file, crs;
  std::uint64_t seed = 0;
  int pictures = 0;
  double gsd_m = 0.0, match_px = 0.0;
  double noise_m = 0.0, weeds_m = 0.0, outliers = 0.0;  ///< of uniform sampling
  double wanted_density_per_m2 = 0.0;
  double area_m2 = 0.0;         ///< of the ground that was sampled
  double density_per_m2 = 0.0;  ///< points over it
  std::int64_t points = 0, ground_points = 0, canopy_points = 0, outlier_points = 0;
  double views_mean = 0.0;
  double horizontal_noise_rms_m = 0.0;  ///< of the errors drawn, both coordinates together
  double height_noise_rms_m = 0.0;
  /// Common error of the whole cloud: method (georeference.h), error in the middle of the area,
  /// rotation about a horizontal axis and about the vertical, scale less 1.
  std::string georeference = "none";
  double georeference_east_m = 0.0, georeference_north_m = 0.0, georeference_up_m = 0.0;
  double georeference_tilt_deg = 0.0, georeference_turn_deg = 0.0, georeference_scale = 0.0;
};

struct CloudTruth {
  std::string scenario, world;
  GeoOrigin origin;
  std::vector<Eigen::Vector2d> boundary_W;
  double bearing_deg = 0.0;  ///< mean of the rows, [0, 180)
  double spacing_m = 0.0;    ///< mean
  double volume_m3 = 0.0;    ///< of all rows
  std::vector<RowTruth> rows;
  CloudSampling sampling;
};

/// Measures a world: ends and gaps with rays down on the line every 2 cm, ends to 0.1 mm;
/// cross-sections by cutting the canopy's meshes across the line every 5 cm; volumes with
/// enclosed_volume_m3() on 2 cm.
/// @returns everything except scenario and sampling
CloudTruth measure_truth(const SceneQuery& scene, const WorldModel& world);

/// Writes JSON with exact numbers. @throws ConfigError if the file cannot be written
void write_cloud_truth(const CloudTruth& truth, const std::filesystem::path& file);
/// @throws ConfigError naming the file and the missing or wrong part
CloudTruth read_cloud_truth(const std::filesystem::path& file);
/// "parcel.truth.json" beside "parcel.las".
std::filesystem::path truth_file_of(std::filesystem::path cloud);

}  // namespace vinerow::mapping
