#include "worlds/mapping/grid/occupancy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "worlds/mapping/grid/rasterise.h"
#include "worlds/mapping/model/row_map.h"

namespace vinerow::mapping {
namespace {

using Eigen::Vector2d;

constexpr std::uint8_t kFree = 0, kOccupied = 1;

/// A strip around a polyline: a rectangle per stretch, and at each bend the mitre that closes the
/// outer side.
void fill_strip(OccupancyGrid& grid, const std::vector<Eigen::Vector3d>& line_W, double half_m,
                double margin_m) {
  constexpr double kMitreLimit = 2.0;  // of half_m; sharper bends are cut off straight
  const std::size_t last = line_W.size() - 1;
  for (std::size_t k = 0; k < last; ++k) {
    const Vector2d d = (line_W[k + 1] - line_W[k]).head<2>().normalized();
    const Vector2d left = half_m * Vector2d(-d.y(), d.x());
    const Vector2d a = line_W[k].head<2>() - (k == 0 ? margin_m : 0.0) * d;
    const Vector2d b = line_W[k + 1].head<2>() + (k + 1 == last ? margin_m : 0.0) * d;
    fill_polygon(grid, {a + left, a - left, b - left, b + left}, kOccupied);
    if (k + 1 == last) continue;
    const Vector2d next = (line_W[k + 2] - line_W[k + 1]).head<2>().normalized();
    const double turn = d.x() * next.y() - d.y() * next.x();
    if (std::abs(turn) < 1e-9) continue;
    const double outer = turn > 0.0 ? -half_m : half_m;  // a bend to the left opens on the right
    const Vector2d from = b + outer * Vector2d(-d.y(), d.x());
    const Vector2d to = b + outer * Vector2d(-next.y(), next.x());
    std::vector<Vector2d> wedge = {b, from, to};
    const Vector2d middle = 0.5 * (from + to) - b;
    const double reach = half_m * half_m / middle.squaredNorm();
    if (reach * middle.norm() <= kMitreLimit * half_m) {
      wedge = {b, from, b + reach * middle, to};
    }
    fill_polygon(grid, wedge, kOccupied);
  }
}

}  // namespace

OccupancyReport plan_occupancy(const RowMap& map, const OccupancyOptions& options) {
  OccupancyReport report;
  if (!options.virtual_walls) return report;
  report.walls =
      make_virtual_walls(map, options.first_wall.value_or(first_wall_of(map)), report.notes);
  report.turning_areas = make_turning_areas(map, report.walls);
  return report;
}

OccupancyGrid make_occupancy_grid(const RowMap& map, const OccupancyOptions& options) {
  return make_occupancy_grid(map, options, plan_occupancy(map, options));
}

OccupancyGrid make_occupancy_grid(const RowMap& map, const OccupancyOptions& options,
                                  const OccupancyReport& report) {
  VINEROW_DEMAND(options.cell_m > 0.0);
  const std::size_t corners = map.boundary_W.size();
  if (corners < 3) {
    throw ConfigError(fmt::format(
        "an occupancy grid needs the parcel's boundary with at least 3 corners, it has {}",
        corners));
  }
  const Eigen::AlignedBox2d box = box_around(map.boundary_W);
  const double cells = cell_count(box, options.cell_m);
  if (!(cells <= static_cast<double>(options.cell_limit))) {
    throw ConfigError(
        fmt::format("occupancy cells of {:g} m make {:.3g} million cells of a parcel of {:.0f} x "
                    "{:.0f} m, must "
                    "be at most {:g} million: use cells of at least {:g} m",
                    options.cell_m, cells * 1e-6, box.sizes().x(), box.sizes().y(),
                    static_cast<double>(options.cell_limit) * 1e-6,
                    cell_that_fits_m(map.boundary_W, options.cell_m, options.cell_limit)));
  }
  OccupancyGrid grid = make_grid_over(box, options.cell_m, kOccupied);
  fill_polygon(grid, map.boundary_W, kFree);
  for (std::size_t k = 0; k < corners; ++k) {
    mark_segment(grid, map.boundary_W[k], map.boundary_W[(k + 1) % corners], kOccupied);
  }
  for (const PlantRow& row : map.rows) {
    fill_strip(grid, row.line_W, 0.5 * row.canopy_width_m, options.row_end_margin_m);
  }
  for (const VirtualWall& wall : report.walls) {
    mark_segment(grid, wall.from_W, wall.to_W, kOccupied);
  }
  for (const auto& obstacle : options.obstacles_W) fill_polygon(grid, obstacle, kOccupied);
  return grid;
}

double cell_that_fits_m(const std::vector<Vector2d>& boundary_W, double cell_m,
                        std::int64_t max_cells) {
  const Eigen::AlignedBox2d box = box_around(boundary_W);
  const auto fits = [&](double cell) {
    return cell_count(box, cell) <= static_cast<double>(max_cells);
  };
  if (fits(cell_m)) return cell_m;
  const double area_m2 = box.sizes().prod();
  double millimetres = std::ceil(1e3 * std::sqrt(area_m2 / static_cast<double>(max_cells)));
  millimetres = std::max(millimetres, std::floor(1e3 * cell_m) + 1.0);
  while (!fits(1e-3 * millimetres)) millimetres = std::ceil(1.001 * millimetres);
  return 1e-3 * millimetres;
}

double free_share(const OccupancyGrid& grid) {
  if (grid.cells.empty()) return 0.0;
  const auto free = std::count(grid.cells.begin(), grid.cells.end(), kFree);
  return static_cast<double>(free) / static_cast<double>(grid.cells.size());
}

}  // namespace vinerow::mapping
