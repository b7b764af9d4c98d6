/// Against the nearest point of every line, looked for one by one.

#include "worlds/mapping/rows/row_locator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/random.h"

namespace vinerow::mapping::row_locator_test {
namespace {

std::vector<RowCurve> arcs() {
  std::vector<RowCurve> lines;
  for (int k = 0; k < 5; ++k) {
    std::vector<Eigen::Vector2d> points;
    const double r = 30.0 + 2.5 * k;
    for (int n = 0; n <= 20; ++n) {
      const double turn = 0.06 * n;
      points.emplace_back(r * std::cos(turn), r * std::sin(turn));
    }
    lines.emplace_back(std::move(points));
  }
  lines.push_back(RowCurve({{-20.0, -40.0}, {60.0, -35.0}}));
  return lines;
}

TEST(RowLocator, FindsTheNearestRowAndThePlaceOnIt) {
  const std::vector<RowCurve> lines = arcs();
  const double reach_m = 1.25;
  const RowLocator locator(lines, reach_m);
  RandomStream random(1, "", "row_locator_test");
  int found = 0, none = 0;
  for (int n = 0; n < 200'000; ++n) {
    const Eigen::Vector2d p(random.uniform(-30.0, 65.0), random.uniform(-50.0, 45.0));
    int nearest = -1;
    double best_m = 1e9, second_m = 1e9, best_s_m = 0.0;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      double apart_m = 0.0;
      const double s_m = lines[k].nearest_s_m(p, &apart_m);
      if (apart_m < best_m) {
        second_m = best_m;
        best_m = apart_m;
        best_s_m = s_m;
        nearest = static_cast<int>(k);
      } else {
        second_m = std::min(second_m, apart_m);
      }
    }
    const double length_m = lines[static_cast<std::size_t>(nearest)].length_m();
    const bool is_alongside = best_s_m > 1e-6 && best_s_m < length_m - 1e-6;
    const RowPlace place = locator.locate(p.x(), p.y());
    // Between two rows a square of the grid belongs to one of them.
    if (second_m - best_m < 0.8) continue;
    if (!is_alongside) continue;
    if (best_m < reach_m - 1e-6) {
      ASSERT_EQ(place.row, nearest) << p.transpose();
      EXPECT_NEAR(std::abs(place.y_m), best_m, 1e-4) << p.transpose();
      EXPECT_NEAR(place.s_m, best_s_m, 1e-4) << p.transpose();
      const RowCurve& line = lines[static_cast<std::size_t>(nearest)];
      const Eigen::Vector2d d = line.direction_W(best_s_m), to = p - line.point_W(best_s_m);
      if (std::abs(place.y_m) > 1e-3) {
        EXPECT_EQ(place.y_m > 0.0, d.x() * to.y() - d.y() * to.x() > 0.0);
      }
      ++found;
    } else if (best_m > reach_m + 1e-6) {
      EXPECT_EQ(place.row, -1) << p.transpose();
      ++none;
    }
  }
  EXPECT_GT(found, 10'000);
  EXPECT_GT(none, 50'000);
}

TEST(RowLocator, GoesOnBehindTheEndsForAMetre) {
  const RowLocator locator({RowCurve({{0.0, 0.0}, {10.0, 0.0}})}, 1.0);
  const RowPlace before = locator.locate(-0.6, 0.3), behind = locator.locate(10.7, -0.4);
  EXPECT_EQ(before.row, 0);
  EXPECT_NEAR(before.s_m, -0.6, 1e-6);
  EXPECT_NEAR(before.y_m, 0.3, 1e-6);
  EXPECT_EQ(behind.row, 0);
  EXPECT_NEAR(behind.s_m, 10.7, 1e-6);
  EXPECT_NEAR(behind.y_m, -0.4, 1e-6);
  EXPECT_EQ(locator.locate(50.0, 50.0).row, -1);
  EXPECT_EQ(locator.locate(std::nan(""), 0.0).row, -1);
}

}  // namespace
}  // namespace vinerow::mapping::row_locator_test
