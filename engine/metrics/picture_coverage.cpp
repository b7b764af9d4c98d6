#include "engine/metrics/picture_coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/api/map.h"
#include "engine/core/error.h"
#include "engine/metrics/coverage_lanes.h"

// Derivation. F_k is the footprint of picture k in the plane, |F| its area.
//
//   forward overlap of consecutive pictures k, k + 1 of a lane: o_k = |F_k and F_{k+1}| / |F_k|
//   covered at cell c: max over all lanes and pairs with c in F_k and F_{k+1} of o_k (`largest`)
//   held at cell c:    max over lanes of the min over that lane's pairs with c in both (`held`)
//   covered and held shares: fraction of the parcel's cells at which these reach wanted_overlap
//
// Ground sampling distance: one pixel at distance d along the optical axis covers gsd = d * IFOV.
// A camera looking straight down from the same height h above the observed ground has h * IFOV.
// With the unit axis a, h = d * down and down = -a_z, so that
//   relative excess = d / h - 1 = 1 / down - 1
//
// Cells are sampled at their centres. A polygon is scanned row by row: its edges cross the
// horizontal line through the row's centres at sorted abscissae x_0 <= x_1 <= ..., and by the
// even-odd rule the centres between x_0 and x_1, x_2 and x_3, ... are inside.

namespace vinerow::metrics {
namespace {

using Eigen::Vector2d;

/// Tolerance for rounding errors of overlaps and of numbers of cells. Chosen: far above the error
/// of double arithmetic on areas of a few thousand m2. Overlaps of cells are stored as float, whose
/// resolution of 6e-8 dominates there.
constexpr double kRounding = 1e-9;
/// Largest number of cells. Chosen: a cell takes 20 bytes, so that a map needs at most 500 MB.
constexpr double kMaxCells = 25e6;

Eigen::AlignedBox2d box_of(const Polygon& polygon) {
  Eigen::AlignedBox2d box;
  for (const Vector2d& p : polygon) box.extend(p);
  return box;
}

/// Calls f for every cell whose centre is in the polygon (even-odd rule).
template <class F>
void for_each_cell_in(const Polygon& polygon, const CoverageMap& map, F&& f) {
  if (polygon.size() < 3) return;
  const Eigen::AlignedBox2d box = box_of(polygon);
  // Fractional index of a row, or below of a column, that is a whole number at a cell's centre.
  const auto row_of = [&](double y) { return (y - map.corner_W.y()) / map.cell_m - 0.5; };
  const int first_row = static_cast<int>(std::ceil(std::max(0.0, row_of(box.min().y()))));
  const int last_row =
      static_cast<int>(std::floor(std::min(map.rows - 1.0, row_of(box.max().y()))));
  std::vector<double> crossings;
  for (int row = first_row; row <= last_row; ++row) {
    const double y = map.corner_W.y() + (row + 0.5) * map.cell_m;
    crossings.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      // Half-open edges: a corner on the line counts for one of its two edges only.
      if ((a.y() <= y) == (b.y() <= y)) continue;
      const double x = a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      crossings.push_back((x - map.corner_W.x()) / map.cell_m - 0.5);
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const int first = static_cast<int>(std::ceil(std::max(0.0, crossings[i])));
      const int last = static_cast<int>(std::floor(std::min(map.columns - 1.0, crossings[i + 1])));
      for (int column = first; column <= last; ++column) f(map.cell(column, row));
    }
  }
}

CoverageMap empty_map(const CoverageOptions& options) {
  const Eigen::AlignedBox2d box = box_of(options.parcel_W);
  CoverageMap map;
  map.corner_W = box.min();
  map.cell_m = options.cell_m;
  map.columns = std::max(1, static_cast<int>(std::ceil(box.sizes().x() / map.cell_m - kRounding)));
  map.rows = std::max(1, static_cast<int>(std::ceil(box.sizes().y() / map.cell_m - kRounding)));
  const std::size_t cells = static_cast<std::size_t>(map.columns) * map.rows;
  map.pictures.assign(cells, -1);
  map.forward_overlap.assign(cells, -1.0f);
  for_each_cell_in(options.parcel_W, map, [&map](std::size_t cell) {
    map.pictures[cell] = 0;
    map.forward_overlap[cell] = 0.0f;
  });
  return map;
}

/// Smallest and largest value, sum and count; or_nan() gives NaN if nothing was added.
struct Summary {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
  double sum = 0.0;
  int count = 0;

  void add(double value) {
    min = std::min(min, value);
    max = std::max(max, value);
    sum += value;
    ++count;
  }
  double or_nan(double value) const {
    return count > 0 ? value : std::numeric_limits<double>::quiet_NaN();
  }
};

/// `largest` and `held` of every cell (see above). Pairs must be added lane by lane.
class CellOverlaps {
 public:
  explicit CellOverlaps(const CoverageMap& map)
      : largest_(map.pictures.size(), 0.0f),
        on_lane_(map.pictures.size(), kNoPair),
        held_(map.pictures.size(), 0.0f) {}

  void add(std::size_t cell, double overlap) {
    largest_[cell] = std::max(largest_[cell], static_cast<float>(overlap));
    on_lane_[cell] = std::min(on_lane_[cell], static_cast<float>(overlap));
  }
  void end_lane() {
    for (std::size_t i = 0; i < held_.size(); ++i) {
      if (on_lane_[i] < kNoPair) held_[i] = std::max(held_[i], on_lane_[i]);
      on_lane_[i] = kNoPair;
    }
  }
  float largest(std::size_t cell) const { return largest_[cell]; }
  float held(std::size_t cell) const { return held_[cell]; }

 private:
  static constexpr float kNoPair = 2.0f;  ///< larger than any overlap, so that min() replaces it
  std::vector<float> largest_, on_lane_, held_;  ///< on_lane_: min over the present lane
};

Summary find_forward_overlaps(const std::vector<PictureFootprint>& footprints,
                              const CoverageMap& map, CellOverlaps& cells) {
  Summary forward;
  for (std::size_t i = 0; i + 1 < footprints.size(); ++i) {
    const PictureFootprint &a = footprints[i], &b = footprints[i + 1];
    if (a.lane != b.lane) cells.end_lane();
    if (b.index != a.index + 1 || a.lane < 0 || a.lane != b.lane) continue;
    const Polygon common = clip(a.polygon_W, b.polygon_W);
    const double overlap = signed_area_m2(common) / a.area_m2;
    if (a.touches_parcel && b.touches_parcel) forward.add(overlap);
    for_each_cell_in(common, map, [&](std::size_t cell) { cells.add(cell, overlap); });
  }
  cells.end_lane();
  return forward;
}

/// Computes the shares of the parcel's cells, and writes the held overlap into the map.
void add_cell_shares(const CellOverlaps& cells, double wanted_overlap, CoverageMap& map) {
  double inside = 0.0, once = 0.0, twice = 0.0, thrice = 0.0, covered = 0.0, held = 0.0;
  const auto wanted = static_cast<float>(wanted_overlap - kRounding);
  for (std::size_t i = 0; i < map.pictures.size(); ++i) {
    if (map.pictures[i] < 0) continue;
    map.forward_overlap[i] = cells.held(i);
    inside += 1.0;
    once += map.pictures[i] >= 1;
    twice += map.pictures[i] >= 2;
    thrice += map.pictures[i] >= 3;
    covered += cells.largest(i) >= wanted;
    held += cells.held(i) >= wanted;
  }
  const auto share = [inside](double count) {
    return inside > 0.0 ? count / inside : std::numeric_limits<double>::quiet_NaN();
  };
  map.numbers["covered_share"] = share(once);
  map.numbers["covered_twice_share"] = share(twice);
  map.numbers["covered_three_times_share"] = share(thrice);
  map.numbers["overlap_covered_share"] = share(covered);
  map.numbers["overlap_held_share"] = share(held);
}

}  // namespace

Polygon footprint_W(const CameraShot& shot) {
  if (!shot.on_ground) return {};
  Polygon corners;
  for (const Eigen::Vector3d& corner : shot.corners_W) corners.push_back(corner.head<2>());
  return convex_hull(std::move(corners));
}

const std::vector<ResultSpec>& coverage_results() {
  using Range = ResultRange;
  static const std::vector<ResultSpec> results = {
      {"shots", "1", Range::count(), "pictures taken", "Number of pictures of the survey camera.",
       "paper A, §2"},
      {"shots_off_ground", "1", Range::count(), "pictures beyond the ground",
       "Number of pictures with a corner beyond the ground or above the horizon. They are excluded "
       "from all other survey metrics; increase the world's surroundings_m to avoid them.",
       ""},
      {"covered_share", "1", Range::share(), "parcel photographed",
       "Fraction of the parcel's cells (cell_m, 1 m) that at least one picture shows.",
       "paper A, §2"},
      {"covered_twice_share", "1", Range::share(), "parcel photographed twice",
       "Fraction of the parcel's cells that at least two pictures show.", "paper A, §2"},
      {"covered_three_times_share", "1", Range::share(), "parcel photographed three times",
       "Fraction of the parcel's cells that at least three pictures show.", "paper A, §2"},
      {"overlap_covered_share", "1", Range::share(), "parcel reaching wanted overlap",
       "Fraction of the parcel's cells shown by at least one pair of consecutive pictures of a "
       "lane whose forward overlap reaches wanted_overlap (0.85).",
       "paper A, §2"},
      {"overlap_held_share", "1", Range::share(), "parcel keeping wanted overlap",
       "Fraction of the parcel's cells for which, on some lane, every pair of consecutive pictures "
       "that both show the cell reaches wanted_overlap (0.85).",
       "paper A, §2"},
      {"forward_overlap_min", "1", Range::share(), "min forward overlap",
       "Smallest forward overlap: area common to two consecutive pictures of a lane divided by the "
       "area of the first, in plan view, if both touch the parcel.",
       "paper A, §2"},
      {"forward_overlap_mean", "1", Range::share(), "mean forward overlap",
       "Mean forward overlap of consecutive pictures of a lane that both touch the parcel.",
       "paper A, §2"},
      {"side_overlap_min", "1", Range::share(), "min side overlap",
       "Smallest side overlap: area common to a picture and the strip photographed on the "
       "neighbouring lane, divided by the area of the picture.",
       "paper A, §2"},
      {"side_overlap_mean", "1", Range::share(), "mean side overlap",
       "Mean side overlap of the pictures that touch the parcel.", "paper A, §2"},
      {"gsd_min_m", "m", Range::from_zero(), "min ground sampling distance",
       "Smallest ground sampling distance along the optical axis, over pictures that touch the "
       "parcel.",
       "paper A, §2"},
      {"gsd_mean_m", "m", Range::from_zero(), "mean ground sampling distance",
       "Mean ground sampling distance along the optical axis, over pictures that touch the parcel: "
       "metres of ground per pixel.",
       "paper A, §2"},
      {"gsd_max_m", "m", Range::from_zero(), "max ground sampling distance",
       "Largest ground sampling distance along the optical axis, over pictures that touch the "
       "parcel.",
       "paper A, §2"},
      {"gsd_formula_error_max", "1", Range::from_zero(), "max GSD excess over formula",
       "Largest absolute relative difference of the ground sampling distance from that of a "
       "picture taken straight down from the same height above the observed ground.",
       "paper A, §2"},
      {"gsd_formula_error_mean", "1", Range::any(), "mean GSD excess over formula",
       "Mean relative excess of the ground sampling distance over that of a picture taken straight "
       "down from the same height above the observed ground.",
       "paper A, §2"}};
  return results;
}

void check_coverage_options(const CoverageOptions& options) {
  const Polygon& parcel = options.parcel_W;
  if (parcel.size() < 3) {
    throw ConfigError(fmt::format("the parcel has {} corners, must be at least 3", parcel.size()));
  }
  if (const auto crossing = find_crossing(parcel)) {
    const auto corner = [&](int i) { return parcel[static_cast<std::size_t>(i) % parcel.size()]; };
    throw ConfigError(
        fmt::format("the parcel crosses itself: its edge from ({:g}, {:g}) m meets the edge from "
                    "({:g}, {:g}) m",
                    corner(crossing->first).x(), corner(crossing->first).y(),
                    corner(crossing->second).x(), corner(crossing->second).y()));
  }
  const Eigen::Vector2d cells = box_of(parcel).sizes() / options.cell_m;
  if (cells.x() * cells.y() > kMaxCells) {
    throw ConfigError(
        fmt::format("cell_m = {:g} m gives {:.0f} million cells, must be at most 25 million",
                    options.cell_m, 1e-6 * cells.x() * cells.y()));
  }
}

CoverageMap map_coverage(const std::vector<LaneShot>& shots, const CoverageOptions& options) {
  check_coverage_options(options);
  CoverageMap map = empty_map(options);
  std::vector<PictureFootprint> footprints;
  Summary gsd, error;
  double error_size = 0.0;
  for (const LaneShot& lane_shot : shots) {
    PictureFootprint footprint;
    footprint.polygon_W = footprint_W(lane_shot.shot);
    footprint.area_m2 = signed_area_m2(footprint.polygon_W);
    if (footprint.area_m2 <= 0.0) continue;
    footprint.index = lane_shot.shot.index;
    footprint.lane = lane_shot.lane;
    footprint.touches_parcel =
        std::abs(signed_area_m2(clip(options.parcel_W, footprint.polygon_W))) > 0.0;
    for_each_cell_in(footprint.polygon_W, map, [&map](std::size_t cell) {
      if (map.pictures[cell] >= 0) ++map.pictures[cell];
    });
    if (footprint.touches_parcel) {
      gsd.add(lane_shot.shot.gsd_m);
      // d / h - 1 = 1 / down - 1
      const double down = -(lane_shot.shot.X_WS.q * Eigen::Vector3d::UnitX()).z();
      error.add(1.0 / down - 1.0);
      error_size = std::max(error_size, std::abs(1.0 / down - 1.0));
    }
    footprints.push_back(std::move(footprint));
  }
  CellOverlaps cells(map);
  const Summary forward = find_forward_overlaps(footprints, map, cells);
  Summary side;
  for (const double overlap : side_overlaps(footprints)) side.add(overlap);

  map.numbers["shots"] = static_cast<double>(shots.size());
  map.numbers["shots_off_ground"] = static_cast<double>(shots.size() - footprints.size());
  add_cell_shares(cells, options.wanted_overlap, map);
  map.numbers["forward_overlap_min"] = forward.or_nan(forward.min);
  map.numbers["forward_overlap_mean"] = forward.or_nan(forward.sum / forward.count);
  map.numbers["side_overlap_min"] = side.or_nan(side.min);
  map.numbers["side_overlap_mean"] = side.or_nan(side.sum / side.count);
  map.numbers["gsd_min_m"] = gsd.or_nan(gsd.min);
  map.numbers["gsd_mean_m"] = gsd.or_nan(gsd.sum / gsd.count);
  map.numbers["gsd_max_m"] = gsd.or_nan(gsd.max);
  map.numbers["gsd_formula_error_max"] = error.or_nan(error_size);
  map.numbers["gsd_formula_error_mean"] = error.or_nan(error.sum / error.count);
  return map;
}

}  // namespace vinerow::metrics
