#include "engine/render/caption.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/engine/render/test_scenes.h"

namespace vinerow::render {
namespace {

Image grey_image() {
  return {640, 360, std::vector<std::uint8_t>(640 * 360 * 3, 120)};
}

TEST(Caption, IsWrittenInTheLowerLeftCornerAndNowhereElse) {
  Image image = grey_image();
  if (!draw_caption({"riseholme", "t = 12.4 s"}, image)) GTEST_SKIP() << "no DejaVu fonts";
  const auto changed = [](const Eigen::Vector3i& p) { return p != Eigen::Vector3i(120, 120, 120); };
  const auto ink = [](const Eigen::Vector3i& p) { return p.minCoeff() > 200; };
  const Eigen::AlignedBox2i panel = test::box_of(image, changed);
  const Eigen::AlignedBox2i text = test::box_of(image, ink);
  ASSERT_FALSE(text.isEmpty());
  EXPECT_TRUE(panel.contains(text));
  EXPECT_LT(panel.max().x(), 320);
  EXPECT_GT(panel.min().y(), 240);
  EXPECT_GT(panel.min().x(), 0);
  EXPECT_LT(panel.max().y(), 359);
  // Rounded: the box's corner pixel keeps the picture's colour.
  EXPECT_EQ(test::pixel(image, panel.min().x(), panel.min().y()), Eigen::Vector3i(120, 120, 120));
}

TEST(Caption, NothingToSayDrawsNothing) {
  Image image = grey_image();
  EXPECT_FALSE(draw_caption({}, image));
  EXPECT_EQ(image.rgb, grey_image().rgb);
}

TEST(Caption, TextLongerThanThePictureIsCutOff) {
  Image image{64, 48, std::vector<std::uint8_t>(64 * 48 * 3, 120)};
  draw_caption({std::string(400, 'W'), "zwei · drei — \xff", "", "five"}, image);
  EXPECT_EQ(image.rgb.size(), 64u * 48u * 3u);
}

TEST(Caption, WithoutFontsThePictureStaysAsItIs) {
  Image image = grey_image();
  setenv("VINEROW_FONTS", "/nonexistent", 1);
  EXPECT_FALSE(draw_caption({"text"}, image));
  unsetenv("VINEROW_FONTS");
  EXPECT_EQ(image.rgb, grey_image().rgb);
}

}  // namespace
}  // namespace vinerow::render
