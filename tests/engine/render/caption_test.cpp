#include "engine/render/caption.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/engine/render/test_scenes.h"

namespace vinerow::render::caption_test {
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

TEST(Caption, ALegendHasASquareOfEachColourInOrder) {
  Image image = grey_image();
  const std::vector<LegendEntry> legend = {{"truth", {1, 0.5f, 0}}, {"no_map", {0, 1, 0}}};
  if (!draw_caption({"riseholme"}, image, legend)) GTEST_SKIP() << "no DejaVu fonts";
  const auto first = [](const Eigen::Vector3i& p) { return p == Eigen::Vector3i(255, 128, 0); };
  const auto second = [](const Eigen::Vector3i& p) { return p == Eigen::Vector3i(0, 255, 0); };
  const auto ink = [](const Eigen::Vector3i& p) { return p.minCoeff() > 200; };
  const Eigen::AlignedBox2i a = test::box_of(image, first), b = test::box_of(image, second);
  ASSERT_FALSE(a.isEmpty() || b.isEmpty());
  EXPECT_EQ(a.sizes(), b.sizes());
  EXPECT_EQ(a.sizes().x(), a.sizes().y());
  EXPECT_GT(a.sizes().x(), 3);
  EXPECT_EQ(a.min().y(), b.min().y()) << "side by side";
  EXPECT_GT(b.min().x(), a.max().x() + 10) << "text between them";
  EXPECT_GT(a.min().y(), test::box_of(image, ink).min().y() + 10) << "below the first line";
}

TEST(Caption, ALegendTakesAsManyRowsAsThePictureIsNarrow) {
  std::vector<LegendEntry> legend(12, LegendEntry{"map_localisation 0.03 m off", {0, 1, 0}});
  Image image = grey_image();
  if (!draw_caption({"riseholme"}, image, legend)) GTEST_SKIP() << "no DejaVu fonts";
  const auto square = [](const Eigen::Vector3i& p) { return p == Eigen::Vector3i(0, 255, 0); };
  int begun = 0, rows = 0;
  for (int y = 0; y < image.height; ++y) {
    int in_row = 0;
    for (int x = 1; x < image.width; ++x) {
      if (square(test::pixel(image, x, y)) && !square(test::pixel(image, x - 1, y))) ++in_row;
    }
    const bool above =
        y > 0 && square(test::pixel(image, test::box_of(image, square).min().x(), y - 1));
    if (in_row > 0 && !above) {
      begun += in_row;
      ++rows;
    }
  }
  EXPECT_EQ(begun, 12);
  EXPECT_GT(rows, 2);
  const auto changed = [](const Eigen::Vector3i& p) { return p != Eigen::Vector3i(120, 120, 120); };
  EXPECT_LT(test::box_of(image, changed).max().x(), 639);
}

bool is_changed(const Eigen::Vector3i& p) {
  return p != Eigen::Vector3i(120, 120, 120);
}

TEST(Caption, GoesToACornerWhereItHidesNothing) {
  const Eigen::AlignedBox2d lower_left(Eigen::Vector2d(10, 330), Eigen::Vector2d(40, 340));
  const Eigen::AlignedBox2d lower_right(Eigen::Vector2d(600, 330), Eigen::Vector2d(639, 359));
  const auto panel = [](const std::vector<Eigen::AlignedBox2d>& keep_clear) {
    Image image = grey_image();
    draw_caption({"riseholme", "t = 12.4 s"}, image, {}, keep_clear);
    return Eigen::AlignedBox2i(test::box_of(image, is_changed));
  };
  if (panel({}).isEmpty()) GTEST_SKIP() << "no DejaVu fonts";
  EXPECT_LT(panel({}).max().x(), 320);
  EXPECT_GT(panel({lower_left}).min().x(), 320);
  EXPECT_GT(panel({lower_left}).min().y(), 180);
  const Eigen::AlignedBox2i upper = panel({lower_left, lower_right});
  EXPECT_LT(upper.max().x(), 320);
  EXPECT_LT(upper.max().y(), 180);
  const Eigen::AlignedBox2d all(Eigen::Vector2d(0, 0), Eigen::Vector2d(640, 360));
  EXPECT_EQ(panel({all}).min(), panel({}).min()) << "no corner is free";
}

// Capital letters of DejaVu Sans are 0.73 em high; pages show pictures at half their size, where 5
// pixels are the least that can be read.
TEST(Caption, CanBeReadInSmallPicturesAndWhereLargeOnesAreShownSmall) {
  EXPECT_GE(0.73 * caption_text_px(270), 8.0);
  EXPECT_GE(0.73 * caption_text_px(720) * 480 / 1280, 5.0);
  EXPECT_GE(0.73 * caption_text_px(720) * 608 / 1280, 7.0);
}

TEST(Caption, ALineWiderThanThePictureEndsWithAnEllipsisInsideIt) {
  Image image = grey_image();
  if (!draw_caption({std::string(200, 'W')}, image)) GTEST_SKIP() << "no DejaVu fonts";
  const auto ink = [](const Eigen::Vector3i& p) { return p.minCoeff() > 200; };
  const Eigen::AlignedBox2i panel = test::box_of(image, is_changed);
  const Eigen::AlignedBox2i text = test::box_of(image, ink);
  EXPECT_LT(panel.max().x(), 639);
  EXPECT_LT(text.max().x(), panel.max().x());
  // The last letters are dots: nothing of them is above the line's lower third.
  const int third = text.max().y() - text.sizes().y() / 3;
  for (int x = text.max().x() - 6; x <= text.max().x(); ++x) {
    for (int y = text.min().y(); y < third; ++y) EXPECT_FALSE(ink(test::pixel(image, x, y)));
  }
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
}  // namespace vinerow::render::caption_test
