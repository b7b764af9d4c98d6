#include "engine/render/pixels.h"

#include <gtest/gtest.h>

#include "engine/render/builtin_textures.h"

namespace vinerow::render::pixels_test {
namespace {

TEST(MipChain, EndsAtOnePixelWithTheMeanColour) {
  Pixels base(8, 4);
  for (int i = 0; i < 32; ++i) base.rgba[4 * i] = static_cast<std::uint8_t>(i < 16 ? 40 : 200);
  const std::vector<Pixels> levels = mip_chain(base);
  ASSERT_EQ(levels.size(), 4u);  // 8x4, 4x2, 2x1, 1x1
  EXPECT_EQ(levels.back().width, 1);
  EXPECT_NEAR(levels.back().rgba[0], 120, 1);  // mean of 40 and 200; one unit for rounding
}

TEST(MipChain, CoverageOfLeafCardsStaysWithDistance) {
  for (const int layer : {int{kLeafSpray}, int{kLeafClump}, int{kGrassLayer}}) {
    const Pixels& card = card_textures()[static_cast<std::size_t>(layer)];
    const double wanted = alpha_coverage(card);
    EXPECT_GT(wanted, 0.1);
    EXPECT_LT(wanted, 0.95);
    const std::vector<Pixels> levels = mip_chain_with_coverage(card);
    for (std::size_t i = 1; i + 3 < levels.size(); ++i) {
      // The share can be met to one row of pixels or so, more coarsely on small levels.
      EXPECT_NEAR(alpha_coverage(levels[i]), wanted, 1.5 / levels[i].width + 0.02)
          << layer << " level " << i;
    }
  }
}

TEST(MipChain, TransparentPixelsDoNotDarkenLeaves) {
  Pixels base(2, 2);
  base.rgba = {200, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_GT(mip_chain_with_coverage(base)[1].rgba[0], 195);
}

TEST(BuiltinTextures, AreTheSameInEveryCallAndSquare) {
  ASSERT_EQ(card_textures().size(), static_cast<std::size_t>(kCardLayers));
  for (const Pixels& card : card_textures()) EXPECT_EQ(card.width, card.height);
  EXPECT_EQ(&ground_texture(), &ground_texture());
}

}  // namespace
}  // namespace vinerow::render::pixels_test
