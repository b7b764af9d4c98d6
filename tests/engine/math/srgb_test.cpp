/// sRGB against the formulas of IEC 61966-2-1, evaluated by Python.

#include <gtest/gtest.h>

#include "engine/math/srgb.h"

namespace vinerow::srgb_test {
namespace {

TEST(Srgb, HasTheValuesOfTheStandard) {
  EXPECT_NEAR(srgb_from_linear(0.18), 0.46135612950044164, 1e-15);
  EXPECT_NEAR(linear_from_srgb(0.5), 0.21404114048223255, 1e-15);
  // A straight line near black.
  EXPECT_DOUBLE_EQ(srgb_from_linear(0.002), 0.02584);
  EXPECT_EQ(srgb_from_linear(0.0), 0.0);
  EXPECT_NEAR(srgb_from_linear(1.0), 1.0, 1e-12);
}

TEST(Srgb, EveryByteComesBack) {
  double before = -1.0;
  for (int byte = 0; byte < 256; ++byte) {
    const double linear = linear_from_srgb(byte / 255.0);
    EXPECT_GT(linear, before);
    EXPECT_NEAR(255.0 * srgb_from_linear(linear), byte, 1e-10);
    before = linear;
  }
}

}  // namespace
}  // namespace vinerow::srgb_test
