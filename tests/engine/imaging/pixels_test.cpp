#include "engine/imaging/pixels.h"

#include <gtest/gtest.h>

namespace vinerow::imaging::pixels_test {
namespace {

TEST(MipChain, EndsAtOnePixelWithTheMeanColour) {
  Pixels base(8, 4);
  for (int i = 0; i < 32; ++i) base.rgba[4 * i] = static_cast<std::uint8_t>(i < 16 ? 40 : 200);
  const std::vector<Pixels> levels = mip_chain(base);
  ASSERT_EQ(levels.size(), 4u);  // 8x4, 4x2, 2x1, 1x1
  EXPECT_EQ(levels.back().width, 1);
  EXPECT_NEAR(levels.back().rgba[0], 120, 1);  // mean of 40 and 200; one unit for rounding
}

TEST(MipChain, TransparentPixelsDoNotDarkenLeaves) {
  Pixels base(2, 2);
  base.rgba = {200, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_GT(mip_chain_with_coverage(base)[1].rgba[0], 195);
}

}  // namespace
}  // namespace vinerow::imaging::pixels_test
