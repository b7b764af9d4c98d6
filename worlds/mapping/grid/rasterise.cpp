#include "worlds/mapping/grid/rasterise.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vinerow::mapping {
namespace {

/// Cells are touched this far outside too, in cells: rounding must not open a line.
constexpr double kTouch = 1e-6;

double first_line(double low_m, double cell_m) {
  return std::floor(low_m / cell_m) - 1.0;
}

double count_along(double low_m, double high_m, double cell_m) {
  return std::floor(high_m / cell_m) + 2.0 - first_line(low_m, cell_m);
}

/// floor() of a value that may be far outside the grid, cut to [-1, count].
int cut_floor(double value, int count) {
  return static_cast<int>(std::floor(std::clamp(value, -1.0, static_cast<double>(count))));
}

}  // namespace

double cell_count(const Eigen::AlignedBox2d& box_W, double cell_m) {
  return count_along(box_W.min().x(), box_W.max().x(), cell_m) *
         count_along(box_W.min().y(), box_W.max().y(), cell_m);
}

OccupancyGrid make_grid_over(const Eigen::AlignedBox2d& box_W, double cell_m, std::uint8_t value) {
  OccupancyGrid grid;
  grid.cell_m = cell_m;
  grid.corner_W = {first_line(box_W.min().x(), cell_m) * cell_m,
                   first_line(box_W.min().y(), cell_m) * cell_m};
  grid.columns = static_cast<int>(count_along(box_W.min().x(), box_W.max().x(), cell_m));
  grid.rows = static_cast<int>(count_along(box_W.min().y(), box_W.max().y(), cell_m));
  grid.cells.assign(static_cast<std::size_t>(grid.columns) * grid.rows, value);
  return grid;
}

void fill_polygon(OccupancyGrid& grid, const std::vector<Eigen::Vector2d>& polygon_W,
                  std::uint8_t value) {
  // Where the lines through the cells' centres cross the polygon: (row, x in cells).
  std::vector<std::pair<int, double>> crossings;
  const std::size_t count = polygon_W.size();
  for (std::size_t k = 0; k < count; ++k) {
    Eigen::Vector2d a = (polygon_W[k] - grid.corner_W) / grid.cell_m;
    Eigen::Vector2d b = (polygon_W[(k + 1) % count] - grid.corner_W) / grid.cell_m;
    if (a.y() > b.y()) std::swap(a, b);
    // Centres j + 0.5 in [a.y, b.y): each vertex belongs to one of its two edges.
    const int first = std::max(cut_floor(std::ceil(a.y() - 0.5), grid.rows), 0);
    const int end = cut_floor(std::ceil(b.y() - 0.5), grid.rows);
    for (int j = first; j < end; ++j) {
      const double share = (j + 0.5 - a.y()) / (b.y() - a.y());
      crossings.emplace_back(j, a.x() + share * (b.x() - a.x()));
    }
  }
  std::sort(crossings.begin(), crossings.end());
  for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
    const int j = crossings[k].first;
    const int first = std::max(cut_floor(std::ceil(crossings[k].second - 0.5), grid.columns), 0);
    const int end = cut_floor(std::ceil(crossings[k + 1].second - 0.5), grid.columns);
    if (first >= end) continue;
    const auto row = grid.cells.begin() + static_cast<std::ptrdiff_t>(j) * grid.columns;
    std::fill(row + first, row + end, value);
  }
}

void mark_segment(OccupancyGrid& grid, const Eigen::Vector2d& a_W, const Eigen::Vector2d& b_W,
                  std::uint8_t value) {
  Eigen::Vector2d a = (a_W - grid.corner_W) / grid.cell_m;
  Eigen::Vector2d b = (b_W - grid.corner_W) / grid.cell_m;
  if (a.x() > b.x()) std::swap(a, b);
  const double run = b.x() - a.x();
  const int last = std::min(cut_floor(b.x() + kTouch, grid.columns), grid.columns - 1);
  for (int i = std::max(cut_floor(a.x() - kTouch, grid.columns), 0); i <= last; ++i) {
    // The stretch of the segment over this column.
    double from = 0.0, to = 1.0;
    if (run > kTouch) {
      from = std::clamp((i - kTouch - a.x()) / run, 0.0, 1.0);
      to = std::clamp((i + 1 + kTouch - a.x()) / run, 0.0, 1.0);
    }
    const double y0 = a.y() + from * (b.y() - a.y()), y1 = a.y() + to * (b.y() - a.y());
    const int top = std::min(cut_floor(std::max(y0, y1) + kTouch, grid.rows), grid.rows - 1);
    for (int j = std::max(cut_floor(std::min(y0, y1) - kTouch, grid.rows), 0); j <= top; ++j) {
      grid.cells[static_cast<std::size_t>(j) * grid.columns + i] = value;
    }
  }
}

}  // namespace vinerow::mapping
