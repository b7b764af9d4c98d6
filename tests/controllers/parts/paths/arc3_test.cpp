#include "controllers/parts/paths/arc3.h"

#include <gtest/gtest.h>

#include "engine/math/angles.h"

namespace vinerow::controllers::arc3_test {
namespace {

TEST(Arc3, PassesItsPointsWhateverItsSweep) {
  for (const double radius : {0.5, 5.0}) {
    for (const double side : {1.0, -1.0}) {
      for (const double sweep : {0.2, 1.0, kPi, 4.0, 6.0}) {
        const Pose2 start = {{3.0, -1.0}, 2.5};
        const Pose2 middle = advance(start, 0.3 * sweep * radius, side * 0.3 * sweep);
        const Pose2 end = advance(start, sweep * radius, side * sweep);
        const auto arc = make_arc3(start.p, middle.p, end.p);
        ASSERT_TRUE(arc.ok());
        // Rounding grows with the inverse of the smallest angle between the points.
        EXPECT_NEAR(arc->length_m, sweep * radius, 1e-10);
        EXPECT_NEAR(arc->curvature_per_m, side / radius, 1e-10);
        EXPECT_NEAR(wrap_angle(arc->start.yaw_rad - start.yaw_rad), 0.0, 1e-10);
      }
    }
  }
}

TEST(Arc3, RefusesPointsOnALineAndEqualPoints) {
  EXPECT_EQ(make_arc3({0, 0}, {1, 0}, {2, 0}).reason(), "the three points of an arc are on a line");
  EXPECT_EQ(make_arc3({0, 0}, {0, 0}, {2, 0}).reason(),
            "two of the three points of an arc coincide");
}

}  // namespace
}  // namespace vinerow::controllers::arc3_test
