#include "worlds/mapping/cloud/make_cloud_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "worlds/mapping/cloud/hulls/row_hull.h"
#include "worlds/mapping/cloud/rows/canopy_raster.h"
#include "worlds/mapping/cloud/rows/cloud_terrain.h"
#include "worlds/mapping/cloud/rows/row_direction.h"
#include "worlds/mapping/cloud/rows/row_lines.h"
#include "worlds/mapping/cloud/rows/row_points.h"
#include "worlds/mapping/cloud/rows/row_tracking.h"
#include "worlds/parts/row_map.h"

namespace vinerow::worlds {
namespace {

constexpr double kRasterCell_m = 0.1;
constexpr double kHighest_m = 6.0;

/// Distances from a row to the next, every metre where both are.
std::vector<double> distances_between(const RowCurve& row, const RowCurve& next) {
  std::vector<double> distances;
  for (double s_m = 0.5; s_m < row.length_m(); s_m += 1.0) {
    double apart_m = 0.0;
    const double other_m = next.nearest_s_m(row.point_W(s_m), &apart_m);
    if (other_m > 0.0 && other_m < next.length_m()) distances.push_back(apart_m);
  }
  return distances;
}

std::string describe_canopy(const CanopyRaster& raster, double cut_m,
                            const std::vector<RowPatch>& patches) {
  double canopy_m2 = 0.0;
  for (const float weight : raster.weights) canopy_m2 += weight > 0.0f ? 1.0 : 0.0;
  canopy_m2 *= raster.cell_m * raster.cell_m;
  if (canopy_m2 < 1.0) {
    return fmt::format("nothing stands more than {:g} m above the ground", cut_m);
  }
  double likelihood = 0.0;
  for (const RowPatch& patch : patches) likelihood = std::max(likelihood, patch.likelihood);
  return fmt::format(
      "{:.0f} m2 are higher than {:g} m, but no two lines of it run beside each other (likelihood "
      "of rows {:.2f})",
      canopy_m2, cut_m, likelihood);
}

struct FoundRows {
  std::vector<RowCurve> lines;  // from the cloud's origin
  double spacing_m = 0.0;
  double body_cut_m = 0.0;
};

FoundRows find_rows(const ParcelCloud& cloud, const HeightField& terrain,
                    const CloudMapOptions& options) {
  const HeightAbove above(terrain, cloud.origin_W);
  FoundRows found;
  found.body_cut_m = body_height_m(cloud, above, options.canopy_cut_m, kHighest_m);
  const CanopyRaster raster =
      make_canopy_raster(cloud, above, kRasterCell_m, found.body_cut_m, kHighest_m);
  RowPatchOptions patch_options;
  patch_options.spacing_low_m = options.spacing_low_m;
  patch_options.spacing_high_m = options.spacing_high_m;
  const std::vector<RowPatch> patches = find_row_patches(coarsen(raster, 2), patch_options);
  const std::vector<RowPatch> likely = agreeing_patches(patches, patch_options);
  if (!likely.empty()) {
    found.spacing_m = median_spacing_m(likely);
    RowTrackingOptions tracking;
    tracking.spacing_m = found.spacing_m;
    RowLineOptions line_options;
    line_options.spacing_m = found.spacing_m;
    line_options.length_low_m = options.row_length_low_m;
    found.lines = fit_row_lines(raster, track_rows(raster, likely, tracking), line_options);
  }
  if (found.lines.size() < 2) {
    throw ConfigError(
        fmt::format("no rows found: {}", describe_canopy(raster, found.body_cut_m, patches)));
  }
  return found;
}

/// Mean bearing of lines that run both ways, in [0, 180) degrees.
double mean_bearing_deg(const std::vector<RowCurve>& lines) {
  double c = 0.0, s = 0.0;
  for (const RowCurve& line : lines) {
    const auto& points = line.points_W();
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      const Eigen::Vector2d d = points[k + 1] - points[k];
      const double twice = 2.0 * std::atan2(d.x(), d.y());
      c += d.norm() * std::cos(twice);
      s += d.norm() * std::sin(twice);
    }
  }
  double bearing = 0.5 * deg_from_rad(std::atan2(s, c));
  if (bearing < 0.0) bearing += 180.0;
  return bearing;
}

double bearing_of_deg(const RowCurve& line) {
  const Eigen::Vector2d d = line.points_W().back() - line.points_W().front();
  const double bearing = deg_from_rad(std::atan2(d.x(), d.y()));
  return bearing < 0.0 ? bearing + 360.0 : bearing;
}

void count_classes(const ParcelCloud& cloud, CloudMapReport& report) {
  for (const PointClass of : cloud.classes) {
    report.ground_points += of == PointClass::kGround ? 1 : 0;
    report.low_points += of == PointClass::kLowVegetation ? 1 : 0;
    report.canopy_points += of == PointClass::kCanopy ? 1 : 0;
    report.other_points += of == PointClass::kOther ? 1 : 0;
  }
}

/// Figures of the rows, and what the whole parcel has of them.
void report_rows(const std::vector<RowHulls>& hulls, const std::vector<RowCanopy>& canopies,
                 const GroundHeight& ground, CloudMapReport& report) {
  std::vector<double> distances;
  double metres = 0.0, contained = 0.0, points = 0.0;
  for (std::size_t r = 0; r < hulls.size(); ++r) {
    MappedRowFigures figures = hulls[r].figures;
    figures.seen_volume_m3 = hulls[r].canopy_volume_m3;
    const RowCurve& line = canopies[r].line;
    const auto on_ground = [&](const Eigen::Vector2d& p) {
      return Eigen::Vector3d(p.x(), p.y(), ground(p.x(), p.y()));
    };
    figures.row = static_cast<int>(r);
    figures.first_W = on_ground(line.points_W().front());
    figures.last_W = on_ground(line.points_W().back());
    figures.length_m = line.length_m();
    figures.bearing_deg = bearing_of_deg(line);
    if (r + 1 < hulls.size()) {
      const auto own = distances_between(line, canopies[r + 1].line);
      double sum = 0.0;
      for (const double d : own) sum += d;
      if (!own.empty()) figures.spacing_m = sum / static_cast<double>(own.size());
      distances.insert(distances.end(), own.begin(), own.end());
    }
    report.canopy_top_m += figures.length_m * figures.canopy_top_m;
    report.canopy_width_m += figures.length_m * figures.canopy_width_m;
    report.volume_m3 += figures.volume_m3;
    report.seen_volume_m3 += figures.seen_volume_m3;
    report.triangles += figures.triangles;
    report.mesh_bytes += hulls[r].mesh_bytes;
    report.section_excess += figures.length_m * hulls[r].section_excess;
    metres += figures.length_m;
    contained += figures.containment * static_cast<double>(figures.points);
    points += static_cast<double>(figures.points);
    for (const std::string& note : hulls[r].notes) report.notes.push_back(note);
    report.rows.push_back(std::move(figures));
  }
  report.canopy_top_m /= metres;
  report.canopy_width_m /= metres;
  report.section_excess /= metres;
  report.containment = points > 0.0 ? contained / points : 0.0;
  if (distances.empty()) return;
  for (const double d : distances) report.spacing_m += d;
  report.spacing_m /= static_cast<double>(distances.size());
  double squares = 0.0;
  for (const double d : distances) squares += (d - report.spacing_m) * (d - report.spacing_m);
  report.spacing_std_m = std::sqrt(squares / static_cast<double>(distances.size()));
}

}  // namespace

void check_options(const CloudMapOptions& options) {
  const auto positive = [](double value, const char* name) {
    if (!(value > 0.0)) throw ConfigError(fmt::format("{} = {:g}, must be > 0", name, value));
  };
  positive(options.terrain_cell_m, "terrain cell");
  positive(options.canopy_cut_m, "canopy cut");
  positive(options.spacing_low_m, "least row spacing");
  positive(options.row_length_low_m, "least row length");
  positive(options.headland_m, "headland");
  const auto not_negative = [](double value, const char* name) {
    if (!(value >= 0.0)) throw ConfigError(fmt::format("{} = {:g}, must be >= 0", name, value));
  };
  not_negative(options.budget_MB, "budget");
  not_negative(options.occupancy.cell_m, "grid cell");
  if (!(options.spacing_low_m < options.spacing_high_m)) {
    throw ConfigError(fmt::format("least row spacing = {:g} m, must be < the largest, {:g} m",
                                  options.spacing_low_m, options.spacing_high_m));
  }
}

CloudMap make_cloud_map(ParcelCloud& cloud, const CloudMapOptions& options,
                        const std::function<void(const std::string&)>& on_phase) {
  check_options(options);
  if (cloud.points.empty()) throw ConfigError("no rows found: the cloud has no points");
  const auto end_phase = [&](const char* name) {
    if (on_phase) on_phase(name);
  };
  CloudMap made;
  CloudMapReport& report = made.report;
  report.points = static_cast<std::int64_t>(cloud.points.size());

  CloudTerrain terrain = fit_terrain(cloud, options.terrain_cell_m);
  report.noise_m = terrain.noise_m;
  report.density_per_m2 = static_cast<double>(report.points) / terrain.covered_m2;
  end_phase("terrain");

  const FoundRows rows = find_rows(cloud, terrain.field, options);
  end_phase("rows");

  RowPointOptions point_options;
  point_options.spacing_m = rows.spacing_m;
  point_options.canopy_cut_m = options.canopy_cut_m;
  point_options.body_cut_m = rows.body_cut_m;
  point_options.ground_m =
      std::min(0.5 * options.canopy_cut_m, std::max(0.1, 3.0 * terrain.noise_m));
  const std::vector<RowCanopy> canopies =
      gather_row_canopies(cloud, terrain.field, rows.lines, point_options);
  count_classes(cloud, report);
  end_phase("points");

  const GroundHeight ground = [&](double x, double y) { return terrain.field.height_m(x, y); };
  RowHullOptions hull_options;
  hull_options.corners = options.corners;
  hull_options.slice_m = options.slice_m;
  hull_options.gap_m = options.gap_m;
  if (options.budget_MB > 0.0) {
    hull_options.budget_bytes = 1e6 * options.budget_MB;
    hull_options.budget_bytes_per_m = 0.0;
  }
  std::vector<RowHulls> hulls = make_row_hulls(canopies, ground, hull_options);
  std::vector<RowCurve> lines_W;
  for (const RowCanopy& canopy : canopies) lines_W.push_back(canopy.line);
  report_rows(hulls, canopies, ground, report);
  report.bearing_deg = mean_bearing_deg(rows.lines);
  end_phase("meshes");

  std::vector<Eigen::Vector2d> boundary_W = options.boundary_W;
  if (boundary_W.empty()) {
    boundary_W = parcel_boundary(lines_W, options.headland_m, options.headland_m);
    report.notes.push_back(
        fmt::format("no boundary was given; the parcel is the box {:g} m beyond the row ends and "
                    "beside the outer rows",
                    options.headland_m));
  }
  made.map = make_row_map(lines_W, ground, CanopyParams{}, std::move(boundary_W));
  double squares = 0.0, metres = 0.0;
  for (std::size_t r = 0; r < hulls.size(); ++r) {
    PlantRow& row = made.map.rows[r];
    const MappedRowFigures& figures = report.rows[r];
    if (figures.canopy_width_m > 0.0) {
      row.canopy_width_m = figures.canopy_width_m;
      row.canopy_base_m = figures.canopy_base_m;
      row.canopy_top_m = figures.canopy_top_m;
    }
    squares += hulls[r].noise_m * hulls[r].noise_m * figures.length_m;
    metres += figures.length_m;
    for (TriangleMesh& mesh : hulls[r].meshes_W) {
      made.map.meshes.push_back({static_cast<int>(r), std::move(mesh)});
    }
  }
  // Points scatter about the true leaves by noise and by the leaves' own depth; a mesh of straight
  // faces is off by as much.
  made.map.accuracy.surface_std_m = std::max(0.01, std::sqrt(squares / metres));
  made.map.terrain = std::move(terrain.field);
  OccupancyOptions grid_options = options.occupancy;
  if (grid_options.cell_m == 0.0) {
    end_phase("grid");
    return made;
  }
  constexpr std::int64_t kMostCells = 30'000'000;
  grid_options.cell_m = cell_that_fits_m(made.map.boundary_W, grid_options.cell_m, kMostCells);
  const OccupancyReport walls = plan_occupancy(made.map, grid_options);
  made.map.occupancy = make_occupancy_grid(made.map, grid_options, walls);
  for (const std::string& note : walls.notes) report.notes.push_back(note);
  end_phase("grid");
  return made;
}

}  // namespace vinerow::worlds
