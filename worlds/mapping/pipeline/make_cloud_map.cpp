#include "worlds/mapping/pipeline/make_cloud_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/math/polygon.h"
#include "worlds/mapping/hulls/row_hull.h"
#include "worlds/mapping/model/row_map.h"
#include "worlds/mapping/rows/canopy_left.h"
#include "worlds/mapping/rows/canopy_raster.h"
#include "worlds/mapping/rows/cloud_terrain.h"
#include "worlds/mapping/rows/row_blocks.h"
#include "worlds/mapping/rows/row_direction.h"
#include "worlds/mapping/rows/row_lines.h"
#include "worlds/mapping/rows/row_points.h"
#include "worlds/mapping/rows/row_tracking.h"

namespace vinerow::mapping {
namespace {

constexpr double kRasterCell_m = 0.1;
constexpr double kHighest_m = 6.0;
// Points per m2 below which ends are off, volumes are too small: docs/guides/jobs.md.
constexpr double kThinForEnds_per_m2 = 60.0;
constexpr double kThinForVolume_per_m2 = 900.0;

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
                            const std::vector<RowPatch>& patches, const RowPatchOptions& searched) {
  double canopy_m2 = 0.0;
  for (const float weight : raster.weights) canopy_m2 += weight > 0.0f ? 1.0 : 0.0;
  canopy_m2 *= raster.cell_m * raster.cell_m;
  if (canopy_m2 < 1.0) {
    return fmt::format("nothing is more than {:g} m above the ground", cut_m);
  }
  double likelihood = 0.0;
  for (const RowPatch& patch : patches) likelihood = std::max(likelihood, patch.likelihood);
  return fmt::format(
      "{:.0f} m2 are higher than {:.2f} m, but no two lines of it are side by side, {:g} to {:g} m "
      "apart as row_spacing_m says (likelihood of rows {:.2f})",
      canopy_m2, cut_m, searched.spacing_low_m, searched.spacing_high_m, likelihood);
}

struct FoundRows {
  std::vector<RowBlock> blocks;  // lines from the cloud's origin
  double body_cut_m = 0.0;
  std::vector<std::string> notes;

  std::vector<RowCurve> lines() const {
    std::vector<RowCurve> all;
    for (const RowBlock& block : blocks) {
      all.insert(all.end(), block.rows.begin(), block.rows.end());
    }
    return all;
  }
  std::vector<double> spacing_of_m() const {
    std::vector<double> all;
    for (const RowBlock& block : blocks)
      all.resize(all.size() + block.rows.size(), block.spacing_m);
    return all;
  }
};

/// Size of the raster's squares, about one point each: larger for sparse clouds.
double raster_cell_m(double density_per_m2) {
  constexpr double kDense_per_m2 = 75.0, kLargest_m = 0.3;
  if (density_per_m2 >= kDense_per_m2) return kRasterCell_m;
  return std::min(kLargest_m, kRasterCell_m * std::sqrt(kDense_per_m2 / density_per_m2));
}

/// Objects as high as rows that are not rows.
void note_canopy_left(const CanopyRaster& raster, const ParcelCloud& cloud, FoundRows& found) {
  constexpr double kReach = 0.6, kMin_m2 = 3.0;
  std::vector<double> reach_m = found.spacing_of_m();
  for (double& reach : reach_m) reach *= kReach;
  const std::vector<CanopyLeft> left =
      find_canopy_left(raster, RowLocator(found.lines(), reach_m), kMin_m2);
  if (left.empty()) return;
  double all_m2 = 0.0;
  for (const CanopyLeft& piece : left) all_m2 += piece.area_m2;
  const Eigen::Vector2d at = left.front().middle() + cloud.origin_W.head<2>();
  const Eigen::Vector2d size = left.front().high - left.front().low;
  found.notes.push_back(
      fmt::format("left out: {:.0f} m2 of canopy higher than {:.1f} m, in {} place{}, in no row "
                  "(trees, hedges, or rows that were not found); the largest place, {:.0f} m2, is "
                  "at about x = {:.0f}, y = {:.0f} in {:.0f} x {:.0f} m",
                  all_m2, found.body_cut_m, left.size(), left.size() == 1 ? "" : "s",
                  left.front().area_m2, at.x(), at.y(), size.x(), size.y()));
}

FoundRows find_rows(const ParcelCloud& cloud, const HeightField& terrain, double density_per_m2,
                    const CloudMapOptions& options) {
  const HeightAbove above(terrain, cloud.origin_W);
  FoundRows found;
  found.body_cut_m = body_height_m(cloud, above, options.canopy_cut_m, kHighest_m);
  const CanopyRaster raster =
      make_canopy_raster(cloud, above, raster_cell_m(density_per_m2), found.body_cut_m, kHighest_m);
  RowPatchOptions patch_options = options.thresholds.direction;
  patch_options.spacing_low_m = options.spacing_low_m;
  patch_options.spacing_high_m = options.spacing_high_m;
  const std::vector<RowPatch> patches =
      find_row_patches(raster.cell_m < 0.15 ? coarsen(raster, 2) : raster, patch_options);
  // The main block first, then blocks of another direction or spacing.
  std::vector<std::vector<RowPatch>> groups{consistent_windows(patches, patch_options)};
  for (std::vector<RowPatch>& group : other_patches(patches, groups.front(), patch_options)) {
    groups.push_back(std::move(group));
  }
  std::vector<RowCurve> lines;
  std::vector<double> spacing_m;
  double too_short_m = 0.0;  // longest line of a group without rows
  TakenSquares taken;
  for (const std::vector<RowPatch>& group : groups) {
    if (group.empty()) continue;
    RowTrackingOptions tracking = options.thresholds.tracking;
    tracking.spacing_m = median_spacing_m(group);
    // A machine that turns at the rows' ends needs more than an alley.
    tracking.open_gap_m = std::max(tracking.open_gap_m, 1.2 * tracking.spacing_m);
    tracking.longest_gap_m = std::max(tracking.longest_gap_m, tracking.open_gap_m);
    RowLineOptions line_options = options.thresholds.lines;
    line_options.spacing_m = tracking.spacing_m;
    line_options.length_low_m = options.row_length_low_m;
    const auto tracks = track_rows(raster, group, tracking, taken);
    const std::vector<RowCurve> found_here = fit_row_lines(raster, tracks, line_options);
    if (found_here.empty()) {
      line_options.length_low_m = 0.0;
      for (const RowCurve& line : fit_row_lines(raster, tracks, line_options)) {
        too_short_m = std::max(too_short_m, line.length_m());
      }
    }
    take_rows(raster, found_here, tracking, taken);
    lines.insert(lines.end(), found_here.begin(), found_here.end());
    spacing_m.resize(lines.size(), tracking.spacing_m);
  }
  found.blocks = split_blocks(lines, spacing_m).blocks;
  if (found.blocks.empty() && too_short_m > 0.0) {
    throw ConfigError(
        fmt::format("no rows found: the longest line of canopy is {:.1f} m long, min_row_length_m "
                    "is {:g} m",
                    too_short_m, options.row_length_low_m));
  }
  if (found.blocks.empty()) {
    throw ConfigError(fmt::format(
        "no rows found: {}", describe_canopy(raster, found.body_cut_m, patches, patch_options)));
  }
  note_canopy_left(raster, cloud, found);
  return found;
}

/// Moves blocks whose rows are inside the boundary to the front. @returns their number
std::size_t put_inside_first(std::vector<RowBlock>& blocks, const ParcelCloud& cloud,
                             const std::vector<Eigen::Vector2d>& boundary_W) {
  if (boundary_W.empty()) return 0;
  const auto outside =
      std::stable_partition(blocks.begin(), blocks.end(), [&](const RowBlock& block) {
        const auto inside =
            std::count_if(block.rows.begin(), block.rows.end(), [&](const RowCurve& row) {
              return contains(boundary_W,
                              row.point_W(0.5 * row.length_m()) + cloud.origin_W.head<2>());
            });
        return 2 * inside > static_cast<std::ptrdiff_t>(block.rows.size());
      });
  return static_cast<std::size_t>(outside - blocks.begin());
}

/// Mean bearing of undirected lines, in [0, 180) degrees.
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
void report_rows(std::span<const RowHulls> hulls, std::span<const RowCanopy> canopies,
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
    metres += figures.length_m;
    contained += figures.containment * static_cast<double>(figures.points);
    points += static_cast<double>(figures.points);
    for (const std::string& note : hulls[r].notes) report.notes.push_back(note);
    report.rows.push_back(std::move(figures));
  }
  report.canopy_top_m /= metres;
  report.canopy_width_m /= metres;
  report.containment = points > 0.0 ? contained / points : 0.0;
  if (distances.empty()) return;
  for (const double d : distances) report.spacing_m += d;
  report.spacing_m /= static_cast<double>(distances.size());
  double squares = 0.0;
  for (const double d : distances) squares += (d - report.spacing_m) * (d - report.spacing_m);
  report.spacing_std_m = std::sqrt(squares / static_cast<double>(distances.size()));
}

/// docs/guides/jobs.md, "How many points a map needs".
void note_density(CloudMapReport& report) {
  const double density_per_m2 = report.density_per_m2;
  if (density_per_m2 < kThinForEnds_per_m2) {
    report.notes.push_back(
        fmt::format("the cloud is thin, {:.0f} points/m2: rows may be missed and their ends be off "
                    "by more than 0.3 m below {:g}, and volumes are unreliable",
                    density_per_m2, kThinForEnds_per_m2));
  } else if (density_per_m2 < kThinForVolume_per_m2) {
    report.notes.push_back(fmt::format(
        "the cloud is thin for volumes, {:.0f} points/m2: in clouds from pictures they were 15 % "
        "too small with 500 points/m2, 5 % with 750, 3 % with 1000; rows and ends are not affected",
        density_per_m2));
  }
}

/// Input of a block's map.
struct BlockParts {
  int block = 0;
  std::span<const RowHulls> hulls;  // of its rows
  std::span<const RowCanopy> canopies;
  const HeightField& terrain;
  const CloudMapReport& of_cloud;           // figures and notes of the whole cloud
  std::vector<Eigen::Vector2d> boundary_W;  // empty: a box
};

void make_grid(CloudMap& map, OccupancyOptions options) {
  if (options.cell_m == 0.0) return;
  constexpr std::int64_t kMaxCells = 30'000'000;
  options.cell_m = cell_that_fits_m(map.map.boundary_W, options.cell_m, kMaxCells);
  const OccupancyReport walls = plan_occupancy(map.map, options);
  map.map.occupancy = make_occupancy_grid(map.map, options, walls);
  for (const std::string& note : walls.notes) map.report.notes.push_back(note);
}

/// Separate map of a block, with rows counted from 0.
CloudMap make_block(const BlockParts& parts, const CloudMapOptions& options) {
  const GroundHeight ground = [&](double x, double y) { return parts.terrain.height_m(x, y); };
  CloudMap made;
  CloudMapReport& report = made.report;
  report = parts.of_cloud;
  report_rows(parts.hulls, parts.canopies, ground, report);
  std::vector<RowCurve> lines_W;
  for (const RowCanopy& canopy : parts.canopies) lines_W.push_back(canopy.line);
  report.bearing_deg = mean_bearing_deg(lines_W);
  for (MappedRowFigures& row : report.rows) row.block = parts.block;
  std::vector<Eigen::Vector2d> boundary_W = parts.boundary_W;
  if (boundary_W.empty()) {
    boundary_W = parcel_boundary(lines_W, options.headland_m, options.headland_m);
    report.notes.push_back(fmt::format(
        "{}; the parcel is the box {:g} m beyond the row ends and beside the outer rows",
        options.boundary_W.empty() ? "no boundary was given"
                                   : "the given boundary is not that of this block alone",
        options.headland_m));
  }
  made.map = make_row_map(lines_W, ground, CanopySize{}, std::move(boundary_W));
  double squares = 0.0, metres = 0.0;
  for (std::size_t r = 0; r < parts.hulls.size(); ++r) {
    PlantRow& row = made.map.rows[r];
    const MappedRowFigures& figures = report.rows[r];
    if (figures.canopy_width_m > 0.0) {
      row.canopy_width_m = figures.canopy_width_m;
      row.canopy_base_m = figures.canopy_base_m;
      row.canopy_top_m = figures.canopy_top_m;
    }
    squares += parts.hulls[r].noise_m * parts.hulls[r].noise_m * figures.length_m;
    metres += figures.length_m;
    for (const TriangleMesh& mesh : parts.hulls[r].meshes_W) {
      made.map.meshes.push_back({static_cast<int>(r), mesh});
    }
  }
  // Points scatter about the true leaves by noise and by the leaves' own depth; a mesh of straight
  // faces is off by as much.
  made.map.accuracy.surface_std_m = std::max(0.01, std::sqrt(squares / metres));
  made.map.terrain = parts.terrain;
  make_grid(made, options.occupancy);
  return made;
}

/// All blocks in one map, to look at and to measure: rows counted through, alleys inside blocks, a
/// grid without virtual walls. What drives takes a block's map.
CloudMap join_blocks(std::vector<CloudMap> blocks, CloudMapReport report,
                     const CloudMapOptions& options) {
  CloudMap whole;
  std::vector<RowCurve> lines_W;
  double metres = 0.0, contained = 0.0, points = 0.0, squares = 0.0;
  std::string list;
  for (const CloudMap& block : blocks) {
    const int first_row = static_cast<int>(whole.map.rows.size());
    const int first_alley = static_cast<int>(whole.map.alleys.size());
    double length_m = 0.0;
    for (std::size_t r = 0; r < block.map.rows.size(); ++r) {
      PlantRow row = block.map.rows[r];
      MappedRowFigures figures = block.report.rows[r];
      row.id = figures.row = first_row + static_cast<int>(r);
      lines_W.emplace_back(from_above(row.line_W));
      length_m += figures.length_m;
      contained += figures.containment * static_cast<double>(figures.points);
      points += static_cast<double>(figures.points);
      whole.map.rows.push_back(std::move(row));
      report.rows.push_back(std::move(figures));
    }
    for (Alley alley : block.map.alleys) {
      alley.id += first_alley;
      whole.map.alleys.push_back(std::move(alley));
    }
    for (const RowMesh& mesh : block.map.meshes) {
      whole.map.meshes.push_back({first_row + mesh.row, mesh.mesh_W});
    }
    const CloudMapReport& r = block.report;
    squares += block.map.accuracy.surface_std_m * block.map.accuracy.surface_std_m * length_m;
    report.canopy_top_m += length_m * r.canopy_top_m;
    report.canopy_width_m += length_m * r.canopy_width_m;
    report.spacing_m += length_m * r.spacing_m;
    report.spacing_std_m += length_m * r.spacing_std_m * r.spacing_std_m;
    report.volume_m3 += r.volume_m3;
    report.seen_volume_m3 += r.seen_volume_m3;
    report.triangles += r.triangles;
    report.mesh_bytes += r.mesh_bytes;
    metres += length_m;
    list += fmt::format(
        "{}block {}, {} rows of {:.0f} m in all, {:.1f} deg from north, {:.2f} m "
        "apart",
        list.empty() ? "" : "; ", block.report.rows.front().block, r.rows.size(), length_m,
        r.bearing_deg, r.spacing_m);
  }
  report.canopy_top_m /= metres;
  report.canopy_width_m /= metres;
  report.spacing_m /= metres;
  report.spacing_std_m = std::sqrt(report.spacing_std_m / metres);
  report.containment = points > 0.0 ? contained / points : 0.0;
  report.bearing_deg = mean_bearing_deg(lines_W);
  report.notes.insert(
      report.notes.begin(),
      fmt::format("{} blocks of rows: {}; each is a map of its own in the folder block_<number>",
                  blocks.size(), list));
  whole.map.boundary_W = options.boundary_W.empty()
                             ? parcel_boundary(lines_W, options.headland_m, options.headland_m)
                             : options.boundary_W;
  whole.map.accuracy.surface_std_m = std::max(0.01, std::sqrt(squares / metres));
  whole.map.terrain = blocks.front().map.terrain;
  whole.report = std::move(report);
  OccupancyOptions grid_options = options.occupancy;
  grid_options.virtual_walls = false;
  make_grid(whole, grid_options);
  whole.blocks = std::move(blocks);
  return whole;
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
    throw ConfigError(fmt::format("row_spacing_m = [{:g}, {:g}], must rise", options.spacing_low_m,
                                  options.spacing_high_m));
  }
}

CloudMap make_cloud_map(ParcelCloud& cloud, const CloudMapOptions& options,
                        const std::function<void(const std::string&)>& on_phase) {
  check_options(options);
  if (cloud.points.empty()) throw ConfigError("no rows found: the cloud has no points");
  const auto end_phase = [&](const char* name) {
    if (on_phase) on_phase(name);
  };
  CloudMapReport report;
  report.points = static_cast<std::int64_t>(cloud.points.size());

  const CloudTerrain terrain =
      fit_terrain(cloud, options.terrain_cell_m, options.thresholds.terrain);
  report.noise_m = terrain.noise_m;
  report.density_per_m2 = static_cast<double>(report.points) / terrain.covered_m2;
  end_phase("terrain");

  FoundRows rows = find_rows(cloud, terrain.field, report.density_per_m2, options);
  const std::size_t inside = put_inside_first(rows.blocks, cloud, options.boundary_W);
  end_phase("rows");

  RowPointOptions point_options;
  point_options.spacing_of_m = rows.spacing_of_m();
  point_options.canopy_cut_m = options.canopy_cut_m;
  point_options.body_cut_m = rows.body_cut_m;
  point_options.ground_m =
      std::min(0.5 * options.canopy_cut_m, std::max(0.1, 3.0 * terrain.noise_m));
  const std::vector<RowCanopy> canopies =
      gather_row_canopies(cloud, terrain.field, rows.lines(), point_options);
  count_classes(cloud, report);
  end_phase("points");

  const GroundHeight ground = [&](double x, double y) { return terrain.field.height_m(x, y); };
  RowHullOptions hull_options = options.thresholds.hulls;
  hull_options.corners = options.corners;
  hull_options.slice_m = options.slice_m;
  hull_options.gap_m = options.gap_m;
  if (options.budget_MB > 0.0) {
    hull_options.budget_bytes = 1e6 * options.budget_MB;
    hull_options.budget_bytes_per_m = 0.0;
  }
  const std::vector<RowHulls> hulls = make_row_hulls(canopies, ground, hull_options);
  end_phase("meshes");

  for (std::string& note : rows.notes) report.notes.push_back(std::move(note));
  note_density(report);
  std::vector<CloudMap> blocks;
  std::size_t first = 0;
  for (std::size_t b = 0; b < rows.blocks.size(); ++b) {
    const std::size_t count = rows.blocks[b].rows.size();
    BlockParts parts{static_cast<int>(b),
                     std::span(hulls).subspan(first, count),
                     std::span(canopies).subspan(first, count),
                     terrain.field,
                     report,
                     {}};
    // A boundary that several blocks lie in is none of theirs alone.
    if (inside == 1 && b == 0) parts.boundary_W = options.boundary_W;
    blocks.push_back(make_block(parts, options));
    first += count;
  }
  if (blocks.size() == 1) {
    end_phase("grid");
    return std::move(blocks.front());
  }
  CloudMap whole = join_blocks(std::move(blocks), std::move(report), options);
  end_phase("grid");
  return whole;
}

}  // namespace vinerow::mapping
