#include "worlds/parts/terrain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/io/geo/raster.h"
#include "engine/math/angles.h"

namespace vinerow::worlds {
namespace {

/// Climb over the first `distance_m` of a slope of one that fades out over `fade_m`.
double faded_climb_m(double distance_m, double fade_m) {
  if (distance_m >= fade_m) return 0.5 * fade_m;
  const double u = distance_m / fade_m;
  return fade_m * (u - u * u * u + 0.5 * u * u * u * u);
}

/// Height of the plane above the hillside at the uphill distance `along_m` from the centre.
double calc_missing_m(const TerrainShape& shape, double along_m) {
  const double above_m = along_m - shape.hillside_to_m;
  if (above_m > 0.0) return above_m - faded_climb_m(above_m, shape.fade_m);
  const double below_m = shape.hillside_from_m - along_m;
  if (below_m > 0.0) return faded_climb_m(below_m, shape.fade_m) - below_m;
  return 0.0;
}

}  // namespace

TerrainSurface::TerrainSurface(const TerrainShape& shape, RandomStream random) : shape_(shape) {
  constexpr int kWaves = 6;
  for (int i = 0; i < kWaves; ++i) {
    // Directions spread evenly with some scatter: six waves of one direction would be furrows.
    const double direction = kPi * (i + random.uniform(0.1, 0.9)) / kWaves;
    const double length_m = shape.wave_length_m * random.uniform(0.7, 1.5);
    const double number = 2.0 * kPi / length_m;
    waves_.push_back({number * Eigen::Vector2d(std::cos(direction), std::sin(direction)),
                      random.uniform(0.0, 2.0 * kPi)});
  }
}

double TerrainSurface::height_m(const Eigen::Vector2d& p_W) const {
  double height = shape_.centre_height_m + shape_.gradient.dot(p_W - shape_.centre_W);
  const double slope = shape_.gradient.norm();
  if (slope > 0.0) {
    const double along_m = shape_.gradient.dot(p_W - shape_.centre_W) / slope;
    height -= slope * calc_missing_m(shape_, along_m);
  }
  // Amplitude h/sqrt(12) each: six of them have rms h/2.
  const double amplitude = shape_.wave_height_m / std::sqrt(12.0);
  if (amplitude > 0.0) {
    for (const Wave& wave : waves_) {
      height += amplitude * std::sin(wave.number_radpm.dot(p_W - shape_.centre_W) + wave.phase_rad);
    }
  }
  return height;
}

HeightField make_height_field(const TerrainSurface& surface, const Eigen::AlignedBox2d& box_W,
                              double cell_m, double clod_height_m, RandomStream random) {
  HeightField field;
  field.cell_m = cell_m;
  field.corner_W = box_W.min();
  field.columns = static_cast<int>(std::ceil(box_W.sizes().x() / cell_m - 1e-9)) + 1;
  field.rows = static_cast<int>(std::ceil(box_W.sizes().y() / cell_m - 1e-9)) + 1;
  field.columns = std::max(field.columns, 2);
  field.rows = std::max(field.rows, 2);
  field.heights_m.reserve(static_cast<std::size_t>(field.columns) * field.rows);
  for (int j = 0; j < field.rows; ++j) {
    for (int i = 0; i < field.columns; ++i) {
      const Eigen::Vector2d p_W = field.corner_W + cell_m * Eigen::Vector2d(i, j);
      double height = surface.height_m(p_W);
      if (clod_height_m > 0.0) height += clod_height_m * random.normal();
      field.heights_m.push_back(static_cast<float>(height));
    }
  }
  return field;
}

RandomStream terrain_random(std::uint64_t seed, const std::string& what) {
  return RandomStream(seed, "", "world.terrain." + what);
}

const ParameterTable<TerrainParams>& terrain_table() {
  using P = TerrainParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("terrain_cell_m", "m", &P::cell_m, between(0.05, 100.0),
                  "distance between samples of the height field")
          .number("waves_m", "m", &P::waves_m, between(0.0, 20.0),
                  "height of the gentle undulation")
          .number("wave_length_m", "m", &P::wave_length_m, kPositive,
                  "typical length of the undulation")
          .number("clods_m", "m", &P::clods_m, between(0.0, 0.2),
                  "standard deviation of small bumps, one per sample")
          .path("dem_file", &P::dem_file, "GeoTIFF of heights; replaces slope and undulation")
          .text("crs", &P::crs,
                "coordinate reference system of dem_file, as EPSG:21781, if the file does not name "
                "it");
  return table;
}

const ParameterTable<SlopeParams>& slope_table() {
  using P = SlopeParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .degrees("slope_deg", &P::slope_rad, between(0.0, 45.0), "mean slope of the ground")
          .degrees("uphill_bearing_deg", &P::uphill_bearing_rad, between(-360.0, 360.0),
                   "direction in which the ground rises, from north clockwise");
  return table;
}

Eigen::Vector2d SlopeParams::gradient() const {
  return std::tan(slope_rad) * bearing_direction(uphill_bearing_rad);
}

Eigen::Vector2d bearing_direction(double bearing_rad) {
  return {std::sin(bearing_rad), std::cos(bearing_rad)};
}

void check_terrain_size(const TerrainParams& params, const Eigen::AlignedBox2d& box_W) {
  const double width_m = box_W.sizes().x(), depth_m = box_W.sizes().y(), cell_m = params.cell_m;
  const double samples = (width_m / cell_m + 1) * (depth_m / cell_m + 1);
  constexpr double kMaxSamples = 25e6;
  if (samples <= kMaxSamples) return;
  throw ConfigError(
      fmt::format("terrain_cell_m = {} m gives {:.3g} million samples over {:.0f} m x {:.0f} m, "
                  "must be at most "
                  "25 million: take cells of {:.2f} m or a smaller parcel",
                  cell_m, samples / 1e6, width_m, depth_m,
                  std::ceil(100.0 * std::sqrt(width_m * depth_m / kMaxSamples)) / 100.0 + 0.01));
}

HeightField build_terrain(const TerrainParams& params, std::uint64_t seed, const GeoOrigin& origin,
                          const TerrainShape& shape, const Eigen::AlignedBox2d& box_W) {
  check_terrain_size(params, box_W);
  const double cell_m = params.cell_m;
  if (!params.dem_file.empty()) {
    const io::ElevationRaster raster = io::read_elevation(params.dem_file, params.crs.value_or(""));
    return io::resample_elevation(raster, origin,
                                  {box_W.min(), box_W.sizes().x(), box_W.sizes().y(), cell_m});
  }
  TerrainShape waved = shape;
  waved.wave_height_m = params.waves_m;
  waved.wave_length_m = params.wave_length_m;
  return make_height_field(TerrainSurface(waved, terrain_random(seed, "waves")), box_W, cell_m,
                           params.clods_m, terrain_random(seed, "clods"));
}

mapping::GroundHeight ground_of(const HeightField& field) {
  return [&field](double x, double y) { return field.height_m(x, y); };
}

}  // namespace vinerow::worlds
