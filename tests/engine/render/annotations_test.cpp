#include "engine/render/annotations.h"

#include <gtest/gtest.h>

#include "engine/render/cameras.h"
#include "engine/render/caption.h"
#include "tests/engine/render/test_scenes.h"

namespace vinerow::render::annotations_test {
namespace {

bool is_ink(const Eigen::Vector3i& p) {
  return p.minCoeff() > 200;
}

/// A name in the middle of a picture from above, 100 px for each metre.
Frame named(double radius_m) {
  Frame frame;
  frame.width = 800;
  frame.height = 400;
  frame.camera = look_at({0, 0, 10}, {0, 0, 0});
  frame.camera.orthographic = true;
  frame.camera.ortho_height_m = 4.0;
  frame.markers.push_back({{0, 0, 0}, radius_m, "rover", {0, 1, 0}});
  return frame;
}

/// Where the name is, beside something seen in the given box.
Eigen::AlignedBox2i name_box_next_to(const Frame& frame, const Eigen::AlignedBox2i& seen_px) {
  Image image{frame.width, frame.height, std::vector<std::uint8_t>(800 * 400 * 3, 120)};
  annotate(frame, {SeenMark{0.01, seen_px}}, image);
  return test::box_of(image, is_ink);
}

TEST(Annotations, ANameStandsBesideWhatIsSeenOfItsVehicle) {
  const Eigen::AlignedBox2i narrow(Eigen::Vector2i(370, 120), Eigen::Vector2i(430, 280));
  const Eigen::AlignedBox2i name = name_box_next_to(named(1.0), narrow);
  if (name.isEmpty()) GTEST_SKIP() << "no DejaVu fonts";
  const int text_px = caption_text_px(400);
  EXPECT_GT(name.min().x(), narrow.max().x());
  EXPECT_LT(name.min().x(), narrow.max().x() + text_px);
  EXPECT_NEAR(name.center().y(), narrow.center().y(), 0.5 * text_px);
}

TEST(Annotations, ANameStaysClearOfAllThatMayBeThereWhereNothingIsSeen) {
  const Eigen::AlignedBox2i name = name_box_next_to(named(1.0), Eigen::AlignedBox2i());
  if (name.isEmpty()) GTEST_SKIP() << "no DejaVu fonts";
  EXPECT_GT(name.min().x(), 400 + 100);
  EXPECT_LT(name.min().x(), 400 + 100 + caption_text_px(400));
}

}  // namespace
}  // namespace vinerow::render::annotations_test
