#include "engine/render/culling.h"

#include <gtest/gtest.h>

#include "engine/core/random.h"
#include "engine/render/cameras.h"

namespace vinerow::render::culling_test {
namespace {

TEST(Frustum, NeverRejectsABoxThatHoldsAVisiblePoint) {
  const Camera camera = look_at({3, -2, 5}, {10, 4, 1}, 0.8);
  const Frustum frustum(calc_clip_from_world(camera, 4.0 / 3.0, 0.1, 100.0));
  RandomStream random(1, "test", "frustum");
  int visible = 0;
  int rejected = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d p(random.uniform(-40, 60), random.uniform(-50, 50),
                            random.uniform(-20, 30));
    const Eigen::Vector3d half(random.uniform(0, 3), random.uniform(0, 3), random.uniform(0, 3));
    const bool seen = frustum.may_see({p - half, p + half});
    const Eigen::Vector3d p_C = camera.X_WC.inverse() * p;
    Eigen::Vector2d pixel;
    const bool inside = p_C.z() > 0.1 && p_C.z() < 100.0 && project(camera, 640, 480, p, pixel) &&
                        pixel.x() > 0 && pixel.x() < 640 && pixel.y() > 0 && pixel.y() < 480;
    if (inside) ++visible;
    if (!seen) ++rejected;
    ASSERT_TRUE(seen || !inside) << p.transpose();
  }
  EXPECT_GT(visible, 500);  // the sample says something about both sides
  EXPECT_GT(rejected, 10000);
}

TEST(Frustum, RejectsTheEmptyBox) {
  const Camera camera = look_at({0, 0, 0}, {1, 0, 0});
  EXPECT_FALSE(Frustum(calc_clip_from_world(camera, 1.0, 0.1, 10.0)).may_see({}));
}

TEST(Lod, NamesAreSplitAtTheSuffixOnly) {
  EXPECT_EQ(split_lod_name("row_3/chunk#lod2").base, "row_3/chunk");
  EXPECT_EQ(split_lod_name("row_3/chunk#lod2").level, 2);
  EXPECT_EQ(split_lod_name("row#lod0_old").level, -1);
  EXPECT_EQ(split_lod_name("row#lodx").level, -1);
  EXPECT_EQ(split_lod_name("post").base, "post");
}

TEST(Lod, CoarserWithDistanceAndNeverBeyondWhatExists) {
  EXPECT_EQ(pick_lod(0.0, 3), 0);
  EXPECT_EQ(pick_lod(25.0, 3), 1);
  EXPECT_EQ(pick_lod(1000.0, 3), 2);
  EXPECT_EQ(pick_lod(1000.0, 2), 1);
  EXPECT_EQ(pick_lod(1000.0, 1), 0);
}

TEST(Lod, SeenDistanceGrowsWhenThePictureGetsSmaller) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(10, -1, -1), Eigen::Vector3d(12, 1, 1));
  const Camera camera = look_at({0, 0, 0}, {1, 0, 0}, 0.96);
  // By definition the true distance at 720 rows and 0.96 rad.
  EXPECT_NEAR(calc_seen_distance(camera, 720, box), 10.0, 1e-9);
  EXPECT_NEAR(calc_seen_distance(camera, 360, box), 20.0, 1e-9);
}

}  // namespace
}  // namespace vinerow::render::culling_test
