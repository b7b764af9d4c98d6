#include "engine/render/ribbons.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/render/culling.h"
#include "tests/engine/render/test_scenes.h"

namespace vinerow::render::ribbons_test {
namespace {

TEST(Ribbon, HasItsWidthInPixelsWhateverTheDistance) {
  const Camera camera = look_at({0, 0, 0}, {1, 0, 0}, 0.9);
  const Eigen::Matrix4d clip_from_world = calc_clip_from_world(camera, 2.0, 0.1, 500.0);
  for (const double away : {3.0, 40.0, 200.0}) {
    Polyline line;
    line.width_px = 6.0f;
    line.points_W = {{away, -0.3 * away, 0}, {away, 0.3 * away, 0}};
    const std::vector<RibbonVertex> vertices =
        make_ribbon(line, nullptr, clip_from_world, camera, 400, 200);
    ASSERT_EQ(vertices.size(), 6u);
    Eigen::AlignedBox1d rows;
    for (const RibbonVertex& v : vertices)
      rows.extend(Eigen::Matrix<double, 1, 1>(100.0 * v.clip[1] / v.clip[3]));
    EXPECT_NEAR(rows.sizes()[0], 6.0, 1e-3);  // single precision
  }
}

TEST(Ribbon, IsCutBehindTheEye) {
  const Camera camera = look_at({0, 0, 1}, {1, 0, 1}, 0.9);
  const Eigen::Matrix4d clip_from_world = calc_clip_from_world(camera, 2.0, 0.1, 500.0);
  Polyline line;
  line.points_W = {{-10, 0, 0}, {10, 0, 0}};
  for (const RibbonVertex& v : make_ribbon(line, nullptr, clip_from_world, camera, 400, 200))
    EXPECT_GT(v.clip[3], 0.0f);
  line.points_W = {{-10, 0, 0}, {-5, 0, 0}};
  EXPECT_TRUE(make_ribbon(line, nullptr, clip_from_world, camera, 400, 200).empty());
}

// 255 alpha steps; along a straight line seen from its side the fade is a straight line too.
TEST(Ribbon, FadesEvenlyBetweenItsPoints) {
  const HeightField field = test::make_level_ground(16.0);
  const Camera camera = look_at({0, -9, 3}, {0, 0, 0}, 0.9);
  const Eigen::Matrix4d clip_from_world = calc_clip_from_world(camera, 2.0, 0.1, 500.0);
  Polyline line;
  line.points_W = {{-2, 0, 1}, {2, 0, 1}};
  line.fade = {0.0f, 1.0f};
  line.alpha = 0.5f;
  int min_alpha = 255, max_alpha = 0;
  for (const RibbonVertex& v : make_ribbon(line, &field, clip_from_world, camera, 400, 200)) {
    const Eigen::Vector4d p_W =
        clip_from_world.inverse() * Eigen::Vector4d(v.clip[0], v.clip[1], v.clip[2], v.clip[3]);
    EXPECT_NEAR(v.colour[3], 127.5 * (p_W.x() / p_W.w() + 2.0) / 4.0, 4.0);
    min_alpha = std::min<int>(min_alpha, v.colour[3]);
    max_alpha = std::max<int>(max_alpha, v.colour[3]);
  }
  EXPECT_EQ(min_alpha, 0);
  EXPECT_EQ(max_alpha, 128);
}

// From 1 m behind the eye, where nothing is drawn, to 1 m before it: half faded at the eye.
TEST(Ribbon, FadesWhereItIsCut) {
  const Camera camera = look_at({0, 0, 1}, {1, 0, 1}, 0.9);
  const Eigen::Matrix4d clip_from_world = calc_clip_from_world(camera, 2.0, 0.01, 500.0);
  Polyline line;
  line.points_W = {{-1, 0.1, 1}, {1, 0.1, 1}};
  line.fade = {0.0f, 1.0f};
  int min_alpha = 255;
  for (const RibbonVertex& v : make_ribbon(line, nullptr, clip_from_world, camera, 400, 200)) {
    min_alpha = std::min<int>(min_alpha, v.colour[3]);
  }
  EXPECT_NEAR(min_alpha, 128, 10);
}

TEST(Ribbon, OddInputMakesNoOddTriangles) {
  const Camera camera = look_at({0, 0, 1}, {1, 0, 1}, 0.9);
  const Eigen::Matrix4d clip_from_world = calc_clip_from_world(camera, 2.0, 0.1, 500.0);
  Polyline line;
  EXPECT_TRUE(make_ribbon(line, nullptr, clip_from_world, camera, 400, 200).empty());
  line.points_W = {{5, 0, 0}};
  EXPECT_TRUE(make_ribbon(line, nullptr, clip_from_world, camera, 400, 200).empty());
  line.points_W = {{5, 0, 0}, {5, 0, 0}, {NAN, 0, 0}, {6, 0, 0}, {7, 1, 0}};
  for (const RibbonVertex& v : make_ribbon(line, nullptr, clip_from_world, camera, 400, 200)) {
    for (const float c : v.clip) EXPECT_TRUE(std::isfinite(c));
  }
}

// Two branches of a tree are two quads, without a line between them and without a joint.
TEST(Ribbon, PairsArePiecesOfTheirOwn) {
  const Camera camera = look_at({0, 0, 1}, {1, 0, 1}, 0.9);
  const Eigen::Matrix4d clip_from_world = calc_clip_from_world(camera, 2.0, 0.1, 500.0);
  Polyline line;
  line.points_W = {{5, -1, 0}, {5, -0.5, 0}, {5, 0.5, 0}, {5, 1, 0}, {9, 9, 9}};  // one left over
  line.pairs = true;
  const std::vector<RibbonVertex> vertices =
      make_ribbon(line, nullptr, clip_from_world, camera, 400, 200);
  ASSERT_EQ(vertices.size(), 12u);
  Eigen::Vector2d left, right;
  ASSERT_TRUE(project(camera, 400, 200, {5, 0.5, 0}, left));
  ASSERT_TRUE(project(camera, 400, 200, {5, -0.5, 0}, right));
  for (const RibbonVertex& v : vertices) {
    const double x = 200.0 + 200.0 * v.clip[0] / v.clip[3];
    EXPECT_TRUE(x < left.x() + 1e-3 || x > right.x() - 1e-3) << x;
  }
}

TEST(Ribbon, FollowsTheGround) {
  HeightField field = test::make_level_ground(16.0);
  for (int j = 0; j < 33; ++j)
    field.heights_m[static_cast<std::size_t>(j) * 33 + 16] = 1.0f;  // a ridge at x = 0
  const Camera camera = look_at({0, -30, 10}, {0, 0, 0}, 0.9);
  const Eigen::Matrix4d clip_from_world = calc_clip_from_world(camera, 2.0, 0.1, 500.0);
  Polyline line;
  line.points_W = {{-5, 0, 0}, {5, 0, 0}};
  double top = -1e9;
  for (const RibbonVertex& v : make_ribbon(line, &field, clip_from_world, camera, 400, 200)) {
    top = std::max(top, 100.0 - 100.0 * v.clip[1] / v.clip[3]);
  }
  Eigen::Vector2d ridge;
  ASSERT_TRUE(project(camera, 400, 200, {0, 0, 1.04}, ridge));
  Eigen::Vector2d ends;
  ASSERT_TRUE(project(camera, 400, 200, {5, 0, 0.04}, ends));
  double highest = 1e9;
  for (const RibbonVertex& v : make_ribbon(line, &field, clip_from_world, camera, 400, 200)) {
    highest = std::min(highest, 100.0 - 100.0 * v.clip[1] / v.clip[3]);
  }
  EXPECT_NEAR(highest, ridge.y(), 2.0);  // half the width
  EXPECT_NEAR(top, ends.y(), 2.0);
}

}  // namespace
}  // namespace vinerow::render::ribbons_test
