#pragma once
/// Terrain: a plane with gentle waves and clods, or an elevation model.

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/height_field.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/core/random.h"
#include "engine/math/geo_origin.h"
#include "worlds/mapping/model/row_curve.h"

namespace vinerow::worlds {

/// h(x, y) = gradient . (p - centre) + waves(p) + height of the centre, plus clods on the grid's
/// samples. Above and below a hillside the gradient may fade out, so that it is between a valley
/// and a ridge.
struct TerrainShape {
  Eigen::Vector2d centre_W = {0, 0};
  double centre_height_m = 0.0;
  Eigen::Vector2d gradient = {0, 0};  ///< dh/dx, dh/dy
  /// Between these distances from the centre, uphill, the ground rises by the gradient. Beyond them
  /// the gradient falls to zero over `fade_m` by the factor 1 - 3 u^2 + 2 u^3, u = distance beyond
  /// over fade_m.
  double hillside_from_m = -std::numeric_limits<double>::infinity();
  double hillside_to_m = std::numeric_limits<double>::infinity();
  double fade_m = 0.0;
  double wave_height_m =
      0.0;  ///< amplitude of the undulation (sum of six plane waves, rms = height / 2)
  double wave_length_m = 40.0;
  double clod_height_m = 0.0;  ///< standard deviation of the samples, independent of each other
};

/// Smooth part of the shape at a point, without clods.
class TerrainSurface {
 public:
  TerrainSurface(const TerrainShape& shape, RandomStream random);
  double height_m(const Eigen::Vector2d& p_W) const;

 private:
  struct Wave {
    Eigen::Vector2d number_radpm;
    double phase_rad;
  };
  TerrainShape shape_;
  std::vector<Wave> waves_;
};

/// Grid over a box (extended to whole cells).
HeightField make_height_field(const TerrainSurface& surface, const Eigen::AlignedBox2d& box_W,
                              double cell_m, double clod_height_m, RandomStream random);

struct TerrainParams {
  double cell_m = 0.5;                  ///< between samples of the height field, >= 0.05
  double waves_m = 0.0;                 ///< TerrainShape::wave_height_m
  double wave_length_m = 40.0;          ///< TerrainShape::wave_length_m
  double clods_m = 0.0;                 ///< TerrainShape::clod_height_m
  std::filesystem::path dem_file = {};  ///< GeoTIFF of heights, or empty
  std::optional<std::string> crs = {};  ///< of dem_file
};
/// `terrain_cell_m`, `waves_m`, `wave_length_m`, `clods_m`, `dem_file`, `crs`.
const ParameterTable<TerrainParams>& terrain_table();

struct SlopeParams {
  double slope_rad = 0.0;
  double uphill_bearing_rad = 0.0;  ///< from north, clockwise

  Eigen::Vector2d gradient() const;  ///< dh/dx, dh/dy
};
/// `slope_deg`, `uphill_bearing_deg`.
const ParameterTable<SlopeParams>& slope_table();

/// Random stream of the ground.
RandomStream terrain_random(std::uint64_t seed, const std::string& what);

/// Unit vector of a bearing (from north, clockwise).
Eigen::Vector2d bearing_direction(double bearing_rad);

/// Checks the size of a box's ground before any work on it.
/// @throws ConfigError if it takes more than 25 million samples, with a cell size that would fit
void check_terrain_size(const TerrainParams& params, const Eigen::AlignedBox2d& box_W);

/// Height field over a box from parameters and a gradient; a `dem_file` replaces both.
/// @throws ConfigError as io::read_elevation and io::resample_elevation; with more than 25 million
/// samples
HeightField build_terrain(const TerrainParams& params, std::uint64_t seed, const GeoOrigin& origin,
                          const TerrainShape& shape, const Eigen::AlignedBox2d& box_W);

/// Height function of a height field, which must outlive it.
mapping::GroundHeight ground_of(const HeightField& field);

}  // namespace vinerow::worlds
