#include "engine/core/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vinerow::random_test {
namespace {

// Known answers of the Random123 distribution (kat_vectors, philox4x32-10).
TEST(Random, PhiloxGivesThePublishedKnownAnswers) {
  EXPECT_EQ(philox4x32_10({0, 0, 0, 0}, {0, 0}),
            (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(
      philox4x32_10({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
      (std::array<std::uint32_t, 4>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(
      philox4x32_10({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
      (std::array<std::uint32_t, 4>{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, SameNamesGiveTheSameStreamAndOtherNamesAnother) {
  RandomStream a(7, "rover", "gps"), b(7, "rover", "gps"), c(7, "rover", "imu"),
      d(8, "rover", "gps");
  const std::uint64_t first = a.next_u64();
  EXPECT_EQ(first, b.next_u64());
  EXPECT_NE(first, c.next_u64());
  EXPECT_NE(first, d.next_u64());
}

TEST(Random, UniformHasTheMomentsOfAUniformVariable) {
  RandomStream random(1, "", "test");
  constexpr int kCount = 200'000;
  double sum = 0.0, sum_squares = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    sum_squares += u * u;
  }
  // Five standard errors: sqrt(1/12/n) and sqrt((1/5 - 1/9)/n).
  EXPECT_NEAR(sum / kCount, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / kCount));
  EXPECT_NEAR(sum_squares / kCount, 1.0 / 3.0, 5.0 * std::sqrt((1.0 / 5.0 - 1.0 / 9.0) / kCount));
}

TEST(Random, NormalHasTheMomentsOfANormalVariable) {
  RandomStream random(1, "", "test");
  constexpr int kCount = 200'000;
  double sum = 0.0, sum_2 = 0.0, sum_4 = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.normal();
    sum += x;
    sum_2 += x * x;
    sum_4 += x * x * x * x;
  }
  // Five standard errors; variances of x, x^2, x^4 are 1, 2, 96.
  EXPECT_NEAR(sum / kCount, 0.0, 5.0 * std::sqrt(1.0 / kCount));
  EXPECT_NEAR(sum_2 / kCount, 1.0, 5.0 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(sum_4 / kCount, 3.0, 5.0 * std::sqrt(96.0 / kCount));
}

}  // namespace
}  // namespace vinerow::random_test
