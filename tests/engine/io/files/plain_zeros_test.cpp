#include "engine/io/files/plain_zeros.h"

#include <gtest/gtest.h>

namespace vinerow::io::plain_zeros_test {
namespace {

TEST(PlainZeros, RoundedZerosHaveNoSign) {
  EXPECT_EQ(plain_zeros("at (-0.00, 2.10) heading -0.0 deg"), "at (0.00, 2.10) heading 0.0 deg");
  EXPECT_EQ(plain_zeros("-0 m, [-0, -0.0] and -0.0."), "0 m, [0, 0.0] and 0.0.");
  EXPECT_EQ(plain_zeros("(-0.0, -0.0)"), "(0.0, 0.0)");
}

TEST(PlainZeros, OtherTextsStayAsTheyAre) {
  for (const char* text : {"", "-0.05 m", "-0.001", "from -1.0 to 10-0", "row-0", "x -0e3", "-0x1",
                           "log -0.0.mcap", "a -0-1", "- 0.0", "--0", "2026-01-05"}) {
    EXPECT_EQ(plain_zeros(text), text);
  }
}

}  // namespace
}  // namespace vinerow::io::plain_zeros_test
