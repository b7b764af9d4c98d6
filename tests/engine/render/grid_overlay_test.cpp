#include "engine/render/grid_overlay.h"
#include "engine/api/messages/grid.h"
#include "engine/api/world_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <utility>

#include "tests/engine/render/test_scenes.h"

namespace vinerow::render::grid_overlay_test {
namespace {

/// 10 m x 10 m around the origin in cells of 0.1 m, all free.
std::shared_ptr<OccupancyGrid> make_free_grid() {
  auto grid = std::make_shared<OccupancyGrid>();
  grid->columns = grid->rows = 100;
  grid->cell_m = 0.1;
  grid->corner_W = {-5, -5};
  grid->cells.assign(100 * 100, 0);
  return grid;
}

/// Takes the cells with x in [x0, x1) and y in [y0, y1), m.
void take(OccupancyGrid& grid, double x0, double x1, double y0, double y1) {
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double x = grid.corner_W.x() + (i + 0.5) * grid.cell_m;
      const double y = grid.corner_W.y() + (j + 0.5) * grid.cell_m;
      const bool inside = x >= x0 && x < x1 && y >= y0 && y < y1;
      if (inside) grid.cells[static_cast<std::size_t>(j) * grid.columns + i] = 1;
    }
  }
}

std::uint8_t occupancy_at(const GridLevel& level, int x, int y) {
  return level.texels[2 * (static_cast<std::size_t>(y) * level.width + x)];
}
std::uint8_t depth_at(const GridLevel& level, int x, int y) {
  return level.texels[2 * (static_cast<std::size_t>(y) * level.width + x) + 1];
}

TEST(GridOverlay, AWallOfOneCellIsSeenAtEveryLevel) {
  const auto grid = make_free_grid();
  take(*grid, -5, 5, 0.0, 0.1);  // row 50
  int cells_a_texel = 0;
  const std::vector<GridLevel> levels = make_grid_levels(*grid, cells_a_texel);
  EXPECT_EQ(cells_a_texel, 1);
  ASSERT_EQ(levels.size(), 7u);
  EXPECT_EQ(levels[0].width, 128);
  // Softened by 1 2 1: half.
  for (std::size_t k = 0; k < levels.size(); ++k)
    EXPECT_EQ(occupancy_at(levels[k], 0, 50 >> k), 127) << k;
  EXPECT_EQ(occupancy_at(levels[0], 20, 51), 63);
  EXPECT_EQ(occupancy_at(levels[0], 20, 53), 0);
}

// The depth of a cell in a wide block is its centre's distance from the edge: 0.05 m, 0.15 m, ...
// in steps of 2 m / 255, for chamfer distances exactly so straight behind an edge.
TEST(GridOverlay, DepthIsTheDistanceFromWhatIsFree) {
  const auto grid = make_free_grid();
  take(*grid, -5, 5, -5, 0);  // rows 0 to 49
  int cells_a_texel = 0;
  const std::vector<GridLevel> levels = make_grid_levels(*grid, cells_a_texel);
  for (const int inside : {0, 1, 5, 12}) {
    EXPECT_NEAR(depth_at(levels[0], 50, 49 - inside), (0.1 * inside + 0.05) * 255 / 2.0, 1.0);
  }
  EXPECT_EQ(depth_at(levels[0], 50, 50), 0);
  // Deeper than 2 m, and at the grid's border, beyond which everything is taken.
  EXPECT_EQ(depth_at(levels[0], 50, 20), 255);
  EXPECT_EQ(depth_at(levels[0], 0, 0), 255);
}

TEST(GridOverlay, LargerGridsAreJoined) {
  OccupancyGrid grid;
  grid.columns = 20'000;
  grid.rows = 3;
  grid.cells.assign(60'000, 0);
  grid.cells[19'999] = 1;  // row 0, last column
  int cells_a_texel = 0;
  const std::vector<GridLevel> levels = make_grid_levels(grid, cells_a_texel);
  EXPECT_EQ(cells_a_texel, 4);
  EXPECT_EQ(levels[0].width, 5056);  // 5000, up to a multiple of 64
  EXPECT_GT(occupancy_at(levels[0], 4999, 0), 127);
  EXPECT_EQ(occupancy_at(levels[0], 4997, 0), 0);
}

/// Bluer than ground ever is.
bool is_violet(const Eigen::Vector3i& p) {
  return p[2] > p[1] + 25 && p[2] > p[0];
}

Frame frame_from_above() {
  Frame frame;
  frame.camera = look_at({0, 0, 50}, {0, 0, 0});
  frame.camera.orthographic = true;
  frame.camera.ortho_height_m = 12.0;  // 20 px a metre
  frame.width = 320;
  frame.height = 240;
  return frame;
}

TEST(GridOverlay, FromAboveItCoversWhatIsTakenAndNothingElse) {
  WorldModel world;
  world.terrain = test::make_level_ground(30.0);
  const auto renderer = test::renderer_of(world);
  ASSERT_TRUE(renderer);
  const auto grid = make_free_grid();
  take(*grid, 1.0, 3.0, -2.0, 0.0);
  Frame frame = frame_from_above();
  const Image plain = renderer->draw(frame);
  EXPECT_TRUE(test::box_of(plain, is_violet).isEmpty());
  frame.grid = grid;
  const Image shown = renderer->draw(frame);
  const Eigen::AlignedBox2i box =
      test::box_of(shown, [&](const Eigen::Vector3i& p) { return is_violet(p); });
  // x 1 to 3 m right of the middle, y 0 to 2 m below it; its last cells' edges are soft.
  EXPECT_NEAR(box.min().x(), 160 + 20, 2);
  EXPECT_NEAR(box.max().x() + 1, 160 + 60, 2);
  EXPECT_NEAR(box.min().y(), 120, 2);
  EXPECT_NEAR(box.max().y() + 1, 120 + 40, 2);
  // Away from it the picture is the same to the bit.
  for (const auto& [x, y] : {std::pair{20, 20}, {160, 60}, {300, 200}}) {
    EXPECT_EQ(test::pixel(plain, x, y), test::pixel(shown, x, y));
  }
  // A frame without grid afterwards is as before.
  frame.grid = nullptr;
  EXPECT_EQ(image_digest(renderer->draw(frame)), image_digest(plain));
}

TEST(GridOverlay, FromAboveItLiesOverThingsElsewhereOnTheGround) {
  WorldModel world;
  world.terrain = test::make_level_ground(30.0);
  world.meshes.push_back(test::make_instance("wall", test::make_box({0.5f, 2.0f, 0.6f}),
                                             {2.0, 0.0, 0.6}, {0.8f, 0.01f, 0.01f}));
  const auto renderer = test::renderer_of(world);
  ASSERT_TRUE(renderer);
  const auto grid = make_free_grid();
  take(*grid, 1.5, 2.5, -2.0, 2.0);
  Frame frame = frame_from_above();
  frame.grid = grid;
  const Image above = renderer->draw(frame);
  EXPECT_TRUE(test::box_of(above, test::is_red).isEmpty()) << "tinted";
  frame.camera = look_at({-6, 0, 1.5}, {2, 0, 0.6});
  const Image ahead = renderer->draw(frame);
  const Eigen::AlignedBox2i wall = test::box_of(ahead, test::is_red);
  ASSERT_FALSE(wall.isEmpty());
  EXPECT_TRUE(test::is_red(test::pixel(ahead, 160, (wall.min().y() + wall.max().y()) / 2)));
}

TEST(GridOverlay, AnotherGridReplacesTheFirst) {
  WorldModel world;
  world.terrain = test::make_level_ground(30.0);
  const auto renderer = test::renderer_of(world);
  ASSERT_TRUE(renderer);
  const auto left = make_free_grid(), right = make_free_grid();
  take(*left, -3, -1, -1, 1);
  take(*right, 1, 3, -1, 1);
  Frame frame = frame_from_above();
  frame.grid = left;
  const std::string first = image_digest(renderer->draw(frame));
  frame.grid = right;
  const Eigen::AlignedBox2i box = test::box_of(renderer->draw(frame), is_violet);
  EXPECT_GT(box.min().x(), 160);
  frame.grid = left;
  EXPECT_EQ(image_digest(renderer->draw(frame)), first);
}

/// Mean and root mean square of the differences, in levels.
std::pair<double, double> differences(const Image& a, const Image& b) {
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const double difference = double{1} * a.rgb[i] - b.rgb[i];
    sum += difference;
    squares += difference * difference;
  }
  const auto count = static_cast<double>(a.rgb.size());
  return {sum / count, std::sqrt(squares / count)};
}

TEST(GridOverlay, WhereAllIsFreeTheGroundAndItsGrassLookAsWithoutIt) {
  // With a grid the shaders compute all noise pixel by pixel, and light tufts at once; without it
  // slow noise comes from the vertices, and tufts are lit with the leaves.
  WorldModel world;
  world.terrain = test::make_level_ground(30.0);
  const auto renderer = test::renderer_of(world);
  ASSERT_TRUE(renderer);
  Frame frame = frame_from_above();
  frame.camera = look_at({-6, 0, 0.7}, {2, 0, 0.2});
  frame.samples = 4;
  const Image plain = renderer->draw(frame);
  frame.grid = make_free_grid();
  const auto [mean, rms] = differences(renderer->draw(frame), plain);
  std::printf("ground and grass by both ways: mean %.2f, rms %.2f levels\n", mean, rms);
  EXPECT_LT(std::abs(mean), 0.3);
  EXPECT_LT(rms, 1.0);
  // The tufts are a part of both.
  RendererSettings bare;
  bare.grass_tufts = false;
  const auto mown = make_renderer(world, bare);
  ASSERT_TRUE(mown);
  EXPECT_GT(differences((*mown)->draw(frame), plain).second, 2.0);
}

}  // namespace
}  // namespace vinerow::render::grid_overlay_test
