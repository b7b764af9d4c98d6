#include "engine/render/builtin_textures.h"

#include <gtest/gtest.h>

namespace vinerow::render::builtin_textures_test {
namespace {

TEST(MipChain, CoverageOfLeafCardsStaysWithDistance) {
  for (const int layer : {int{kLeafSpray}, int{kLeafClump}, int{kGrassLayer}}) {
    const imaging::Pixels& card = card_texture(layer);
    const double wanted = imaging::alpha_coverage(card);
    EXPECT_GT(wanted, 0.1);
    EXPECT_LT(wanted, 0.95);
    const std::vector<imaging::Pixels> levels = imaging::mip_chain_with_coverage(card);
    for (std::size_t i = 1; i + 3 < levels.size(); ++i) {
      // The share can be met to one row of pixels or so, more coarsely on small levels.
      EXPECT_NEAR(imaging::alpha_coverage(levels[i]), wanted, 1.5 / levels[i].width + 0.02)
          << layer << " level " << i;
    }
  }
}

TEST(BuiltinTextures, AreTheSameInEveryCallAndSquare) {
  for (int layer = 0; layer < kCardLayers; ++layer) {
    const imaging::Pixels& card = card_texture(layer);
    EXPECT_EQ(card.width, card.height);
    EXPECT_EQ(card.width, card_texture(0).width);
    EXPECT_EQ(&card, &card_texture(layer));
  }
  EXPECT_EQ(&ground_texture(), &ground_texture());
}

}  // namespace
}  // namespace vinerow::render::builtin_textures_test
