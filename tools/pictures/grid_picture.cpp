#include "tools/pictures/grid_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/map.h"
#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "engine/math/polygon.h"
#include "engine/render/scale_bar.h"
#include "tools/pictures/legend.h"
#include "tools/pictures/picture_style.h"
#include "tools/pictures/plan_view.h"

namespace vinerow::tools {
namespace {

using Eigen::Vector2d;

constexpr Rgb kFree = {240, 233, 217}, kOutside = {92, 98, 100}, kOccupied = {52, 50, 48};
constexpr Rgb kPlants = {74, 134, 62}, kWall = {28, 92, 214}, kTurning = {252, 204, 60};
constexpr Rgb kObstacle = {214, 84, 26};

/// State of a cell: -1 beyond the grid, otherwise 0 or 1.
int state_at(const OccupancyGrid& grid, const Vector2d& p_W) {
  const Vector2d cell = (p_W - grid.corner_W) / grid.cell_m;
  const int i = static_cast<int>(std::floor(cell.x())), j = static_cast<int>(std::floor(cell.y()));
  if (i < 0 || j < 0 || i >= grid.columns || j >= grid.rows) return -1;
  return grid.occupied(i, j) ? 1 : 0;
}

/// Draws the free ground.
void draw_free_ground(Canvas& canvas, const PlanView& view, const OccupancyGrid& grid) {
  const Vector2d &low = grid.corner_W, high = low + grid.cell_m * Vector2d(grid.columns, grid.rows);
  canvas.fill(view(render::rectangle(low.x(), low.y(), high.x(), high.y())), kFree);
}

/// Draws the occupied cells, with 3 x 3 samples per pixel.
void draw_occupied_cells(Canvas& canvas, const PlanView& view, const WorldModel& world) {
  constexpr int kSamples = 3;
  const OccupancyGrid& grid = world.rows->occupancy;
  const std::vector<Vector2d>& boundary = world.rows->boundary_W;
  // Occupied cells that belong to a row.
  OccupancyGrid rows;
  if (boundary.size() >= 3) {
    mapping::OccupancyOptions options;
    options.cell_m = grid.cell_m;
    options.row_end_margin_m = 0.5;  // only occupied cells are coloured
    options.virtual_walls = false;
    rows = mapping::make_occupancy_grid(world.rows, options);
  }
  for (int y = 0; y < view.map_height; ++y) {
    for (int x = 0; x < kPictureWidth; ++x) {
      int occupied = 0;
      std::array<int, 3> sum = {0, 0, 0};
      for (int s = 0; s < kSamples * kSamples; ++s) {
        const Vector2d p =
            view.world(x + (s % kSamples + 0.5) / kSamples, y + (s / kSamples + 0.5) / kSamples);
        if (state_at(grid, p) != 1) continue;
        ++occupied;
        const bool row = !rows.empty() && state_at(rows, p) == 1;
        const bool inside = boundary.empty() || contains(boundary, p);
        const Rgb& colour = !inside ? kOutside : row ? kPlants : kOccupied;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += colour[c];
      }
      if (occupied == 0) continue;
      canvas.blend(x, y, {sum[0] / occupied, sum[1] / occupied, sum[2] / occupied},
                   occupied / static_cast<double>(kSamples * kSamples));
    }
  }
}

/// Draws boxes of the world; those on the map are dark already.
int draw_obstacles(Canvas& canvas, const PlanView& view, const WorldModel& world) {
  int unknown = 0;
  for (const MeshInstance& instance : world.meshes) {
    if (!instance.collides || instance.name.rfind("obstacle/", 0) != 0) continue;
    const Eigen::AlignedBox3d box = instance.mesh->bounds();
    std::vector<Vector2d> plan;
    for (const auto corner :
         {Eigen::AlignedBox3d::BottomLeftFloor, Eigen::AlignedBox3d::BottomRightFloor,
          Eigen::AlignedBox3d::TopRightFloor, Eigen::AlignedBox3d::TopLeftFloor}) {
      plan.push_back((instance.X_WM * Eigen::Vector3d(box.corner(corner))).head<2>());
    }
    const bool known = state_at(world.rows->occupancy, instance.X_WM.p.head<2>()) == 1;
    unknown += !known;
    if (!known) canvas.fill(view(plan), kObstacle, 0.85);
    canvas.outline(view(plan), 2.0, known ? kOccupied : kObstacle);
  }
  return unknown;
}

/// Draws the number of each alley at its first point.
void draw_alley_numbers(Canvas& canvas, const PlanView& view, const RowMap& map) {
  for (const Alley& alley : map.alleys) {
    const double space_px = (alley.width_m - 0.6) * view.px_per_m;
    const int size_px = static_cast<int>(std::clamp(0.8 * space_px, 0.0, 20.0));
    if (size_px < 8) continue;
    const Vector2d a = alley.line_W[0].head<2>(), b = alley.line_W[1].head<2>();
    const Vector2d at =
        view(Vector2d(a + std::min(1.2 * alley.width_m, 3.5) * (b - a).normalized()));
    canvas.text(std::to_string(alley.id), size_px, at + Vector2d(0.0, 0.36 * size_px), kInk, 0.5);
  }
}

}  // namespace

render::Image draw_grid(const WorldModel& world, const mapping::OccupancyReport& report,
                        const std::string& title) {
  const OccupancyGrid& grid = world.rows->occupancy;
  const PlanView view(grid.corner_W, grid.cell_m * Vector2d(grid.columns, grid.rows), kNarrowMargin,
                      kTallestPlan, 104);
  Canvas canvas(kPictureWidth, view.height, kPaper);
  draw_free_ground(canvas, view, grid);
  for (const mapping::TurningArea& area : report.turning_areas) {
    canvas.fill(view(area.polygon_W), kTurning, 0.5);
    canvas.outline(view(area.polygon_W), 1.0, {196, 146, 10}, 0.7);
  }
  draw_occupied_cells(canvas, view, world);
  canvas.outline(view(world.rows->boundary_W), 2.5, kBoundary);
  for (const mapping::VirtualWall& wall : report.walls) {
    canvas.line(view(wall.from_W), view(wall.to_W), 3.5, kWall);
  }
  draw_alley_numbers(canvas, view, world.rows);
  const int unknown = draw_obstacles(canvas, view, world);

  const double top = view.map_height + 14.0;
  canvas.text(title, 22, {static_cast<double>(view.margin), top + 14.0}, kInk);
  canvas.text(fmt::format("{} rows, {} alleys (numbered), {} x {} cells of {:g} m, {:.1f} % free",
                          world.rows->rows.size(), world.rows->alleys.size(), grid.columns,
                          grid.rows, grid.cell_m, 100.0 * mapping::free_share(grid)),
              16, {static_cast<double>(view.margin), top + 40.0}, kFaint);
  double x = view.margin;
  const auto legend = [&](const Rgb& colour, const std::string& words, bool shown) {
    if (!shown) return;
    draw_legend_patch(canvas, x, top + 56.0, colour, words);
    x += 58.0 + 8.6 * static_cast<double>(words.size());
  };
  legend(kFree, "free", true);
  legend(kPlants, "plant row", !world.rows->rows.empty());
  legend(kWall, "virtual wall", !report.walls.empty());
  legend({246, 219, 139}, "turning area", !report.turning_areas.empty());
  legend(kOutside, "outside the parcel", true);
  legend(kObstacle, "box missing on the map", unknown > 0);
  draw_scale_bar(canvas, {kPictureWidth - view.margin, top + 44.0},
                 0.125 * kPictureWidth / view.px_per_m, view.px_per_m, kInk);
  return canvas.image();
}

}  // namespace vinerow::tools
