/// Textures of the ground repeat nowhere: seen from above, what lies one tile further on is no more
/// alike than what lies as far away in other directions.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/api/world_model.h"
#include "engine/math/angles.h"
#include "tests/engine/render/test_scenes.h"

namespace vinerow::render::repetition_test {
namespace {

constexpr int kWidth = 768;
constexpr int kHeight = 512;

/// Level grass from straight above, in a light without shadows.
Image draw_grass(double metres_per_pixel) {
  WorldModel world;
  world.terrain = test::make_level_ground(400.0);
  RendererSettings settings;
  settings.shadows = false;
  settings.distant_hills = false;
  const auto renderer = test::renderer_of(world, settings);
  if (!renderer) return {};
  Frame frame;
  frame.camera = look_at({31.0, 17.0, 200.0}, {31.0, 17.0, 0.0});
  frame.camera.orthographic = true;
  frame.camera.ortho_height_m = kHeight * metres_per_pixel;
  frame.width = kWidth;
  frame.height = kHeight;
  frame.samples = 1;
  return renderer->draw(frame);
}

/// Correlation of a picture's green channel with itself, shifted by `by_m` (east, north).
double correlation(const Image& image, double metres_per_pixel, const Eigen::Vector2d& by_m) {
  const int dx = static_cast<int>(std::lround(by_m.x() / metres_per_pixel));
  const int dy = static_cast<int>(std::lround(-by_m.y() / metres_per_pixel));
  double n = 0.0, a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
  for (int y = std::max(0, -dy); y < std::min(kHeight, kHeight - dy); ++y) {
    for (int x = std::max(0, -dx); x < std::min(kWidth, kWidth - dx); ++x) {
      const double here = test::pixel(image, x, y)[1];
      const double there = test::pixel(image, x + dx, y + dy)[1];
      n += 1.0;
      a += here;
      b += there;
      aa += here * here;
      bb += there * there;
      ab += here * there;
    }
  }
  return (ab / n - a / n * b / n) / std::sqrt((aa / n - a / n * a / n) * (bb / n - b / n * b / n));
}

/// Correlation one tile further on, less the mean over eight directions between.
double calc_excess(const Image& image, double metres_per_pixel, double tile_m, double turned_rad) {
  const auto at = [&](double angle_rad) {
    return correlation(image, metres_per_pixel,
                       tile_m * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
  };
  double others = 0.0;
  for (int k = 0; k < 4; ++k) {
    for (const double between : {0.35, 0.65}) others += at(turned_rad + (k + between) * 0.5 * kPi);
  }
  double tiles = 0.0;
  for (int k = 0; k < 4; ++k) tiles += at(turned_rad + k * 0.5 * kPi);
  return tiles / 4.0 - others / 8.0;
}

TEST(Ground, NoTileOfItsTexturesIsSeenTwice) {
  // From far above: tiles of 61 m and, turned, of 10 m. Plain tiles reach 0.75 and 0.26.
  const Image far = draw_grass(0.4);
  ASSERT_FALSE(far.rgb.empty());
  EXPECT_LT(calc_excess(far, 0.4, 1.0 / 0.0163, 0.0), 0.05);
  EXPECT_LT(calc_excess(far, 0.4, 1.0 / 0.098, -std::atan2(0.6, 0.8)), 0.05);
  // From near: blades of grass on tiles of 2.1 m and 5.8 m. Plain tiles reach 0.46 and 0.31.
  const Image near = draw_grass(0.02);
  ASSERT_FALSE(near.rgb.empty());
  EXPECT_LT(calc_excess(near, 0.02, 1.0 / 0.476, 0.0), 0.05);
  EXPECT_LT(calc_excess(near, 0.02, 1.0 / 0.171, -std::atan2(0.84, 0.54)), 0.05);
}

}  // namespace
}  // namespace vinerow::render::repetition_test
