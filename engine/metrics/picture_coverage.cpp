#include "engine/metrics/picture_coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/api/map.h"
#include "engine/core/error.h"
#include "engine/metrics/coverage_lanes.h"

namespace vinerow::metrics {
namespace {

using Eigen::Vector2d;

/// Overlaps are compared with a limit up to rounding.
constexpr double kRounding = 1e-9;
constexpr double kMostCells = 25e6;

Eigen::AlignedBox2d box_of(const Polygon& polygon) {
  Eigen::AlignedBox2d box;
  for (const Vector2d& p : polygon) box.extend(p);
  return box;
}

/// Calls back for every cell whose middle lies in the polygon (even-odd rule).
template <class F>
void for_each_cell_in(const Polygon& polygon, const CoverageMap& map, F&& f) {
  if (polygon.size() < 3) return;
  const Eigen::AlignedBox2d box = box_of(polygon);
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
  map.columns = std::max(1, static_cast<int>(std::ceil(box.sizes().x() / map.cell_m - 1e-9)));
  map.rows = std::max(1, static_cast<int>(std::ceil(box.sizes().y() / map.cell_m - 1e-9)));
  const std::size_t cells = static_cast<std::size_t>(map.columns) * map.rows;
  map.pictures.assign(cells, -1);
  map.forward_overlap.assign(cells, -1.0f);
  for_each_cell_in(options.parcel_W, map, [&map](std::size_t cell) {
    map.pictures[cell] = 0;
    map.forward_overlap[cell] = 0.0f;
  });
  return map;
}

/// Smallest, largest and mean of what was added; NaN of nothing.
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

/// Of every cell the largest overlap of a pair of pictures that both see it, and the smallest such
/// overlap on the lane where that is largest.
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
  static constexpr float kNoPair = 2.0f;
  std::vector<float> largest_, on_lane_, held_;
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

/// Fills the map's overlap too.
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

const std::vector<MetricNumber>& coverage_numbers() {
  static const std::vector<MetricNumber> numbers = {count_number("shots"),
                                                    count_number("shots_off_ground"),
                                                    share_number("covered_share"),
                                                    share_number("covered_twice_share"),
                                                    share_number("covered_three_times_share"),
                                                    share_number("overlap_covered_share"),
                                                    share_number("overlap_held_share"),
                                                    share_number("forward_overlap_min"),
                                                    share_number("forward_overlap_mean"),
                                                    share_number("side_overlap_min"),
                                                    share_number("side_overlap_mean"),
                                                    from_zero("gsd_min_m"),
                                                    from_zero("gsd_mean_m"),
                                                    from_zero("gsd_max_m"),
                                                    from_zero("gsd_formula_error_max"),
                                                    signed_number("gsd_formula_error_mean")};
  return numbers;
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
  if (cells.x() * cells.y() > kMostCells) {
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
  for (const LaneShot& taken : shots) {
    PictureFootprint footprint;
    footprint.polygon_W = footprint_W(taken.shot);
    footprint.area_m2 = signed_area_m2(footprint.polygon_W);
    if (footprint.area_m2 <= 0.0) continue;
    footprint.index = taken.shot.index;
    footprint.lane = taken.lane;
    footprint.touches_parcel =
        std::abs(signed_area_m2(clip(options.parcel_W, footprint.polygon_W))) > 0.0;
    for_each_cell_in(footprint.polygon_W, map, [&map](std::size_t cell) {
      if (map.pictures[cell] >= 0) ++map.pictures[cell];
    });
    if (footprint.touches_parcel) {
      gsd.add(taken.shot.gsd_m);
      // Straight down from the height h above the point looked at, distance d away, the formula
      // gives h / d of what is reported.
      const double down = -(taken.shot.X_WS.q * Eigen::Vector3d::UnitX()).z();
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
