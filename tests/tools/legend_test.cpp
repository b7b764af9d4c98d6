#include "tools/pictures/legend.h"

#include <gtest/gtest.h>

namespace vinerow::tools::legend_test {
namespace {

TEST(Legend, WhatAPictureShowsHasNoShareOfZero) {
  EXPECT_EQ(share_text(0, 1000), "0 %");
  EXPECT_EQ(share_text(1, 1000), "< 1 %");
  EXPECT_EQ(share_text(4, 1000), "< 1 %");
  EXPECT_EQ(share_text(6, 1000), "1 %");
  EXPECT_EQ(share_text(154, 1000), "15 %");
  EXPECT_EQ(share_text(1000, 1000), "100 %");
  EXPECT_EQ(share_text(0, 0), "0 %") << "an empty cloud";
}

}  // namespace
}  // namespace vinerow::tools::legend_test
