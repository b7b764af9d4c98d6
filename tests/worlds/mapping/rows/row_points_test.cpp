/// Classes and row frames of points that are placed by hand. A whole parcel:
/// row_detection_test.cpp.

#include "worlds/mapping/rows/row_points.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace vinerow::mapping::row_points_test {
namespace {

using Eigen::Vector2d;

/// Level ground at z = 300 m around (1000, 2000).
HeightField level_field() {
  HeightField field;
  field.columns = field.rows = 2;
  field.cell_m = 200.0;
  field.corner_W = {900.0, 1900.0};
  field.heights_m.assign(4, 300.0f);
  return field;
}

/// Row of 20 m along x through y = 0: a wall of 0.6 m between two heights, points 0.05 m apart.
struct Wall {
  ParcelCloud cloud;
  std::vector<RowCurve> lines{RowCurve({Vector2d(0.0, 0.0), Vector2d(20.0, 0.0)})};

  Wall(double base_m, double top_m) {
    cloud.origin_W = {1000.0, 2000.0, 300.0};
    for (double x = 0.025; x < 20.0; x += 0.05) {
      for (double z = base_m + 0.025; z < top_m; z += 0.05) {
        for (const double y : {-0.3, 0.3}) add(x, y, z);
      }
    }
  }
  std::size_t add(double x, double y, double z) {
    cloud.points.push_back(Eigen::Vector3d(x, y, z).cast<float>());
    return cloud.points.size() - 1;
  }
};

TEST(RowPoints, EachPointHasTheClassOfItsHeightAndPlace) {
  Wall wall(0.6, 2.0);
  struct Case {
    double x, y, z;
    PointClass wanted;
  };
  const Case cases[] = {
      {5.0, 0.0, 0.1, PointClass::kGround},
      {5.0, 1.0, 0.3, PointClass::kLowVegetation},
      {5.0, 0.3, 1.5, PointClass::kCanopy},
      {5.0, 1.2, 1.5, PointClass::kCanopy},         // above the body's cut: up to half a spacing
      {5.0, 0.9, 0.8, PointClass::kLowVegetation},  // beside the body, below its cut
      {5.0, 1.5, 1.5, PointClass::kOther},          // beyond half a spacing
      {5.0, 0.0, 6.5, PointClass::kOther},          // a bird
      {20.1, 0.0, 1.5, PointClass::kCanopy},        // a leaf at the end
      {20.5, 0.0, 1.5, PointClass::kOther},         // beyond it
      {5.0, 0.0, 0.3, PointClass::kLowVegetation},  // below the canopy
  };
  std::vector<std::size_t> at;
  for (const Case& c : cases) at.push_back(wall.add(c.x, c.y, c.z));
  gather_row_canopies(wall.cloud, level_field(), wall.lines, {});
  for (std::size_t k = 0; k < at.size(); ++k) {
    EXPECT_EQ(wall.cloud.classes[at[k]], cases[k].wanted)
        << cases[k].x << " " << cases[k].y << " " << cases[k].z;
  }
}

TEST(RowPoints, CanopyGoesDownToWhereItThinsOut) {
  // The cut is 0.55 m. A wall from 0.35 m is connected with the canopy above it; one from the
  // ground is weeds up to the cut.
  for (const double base_m : {0.35, 0.0}) {
    Wall wall(base_m, 2.0);
    const std::vector<RowCanopy> rows =
        gather_row_canopies(wall.cloud, level_field(), wall.lines, {});
    ASSERT_EQ(rows.size(), 1u);
    float lowest = 10.0f;
    for (const Eigen::Vector3f& p : rows[0].points) lowest = std::min(lowest, p.z());
    EXPECT_NEAR(lowest, base_m > 0.0 ? 0.375 : 0.575, 0.051);
  }
}

TEST(RowPoints, PointsAreInTheFrameOfTheirRow) {
  Wall wall(0.6, 2.0);
  // A second row to the north-west whose left is to the south-west.
  wall.lines.emplace_back(std::vector<Vector2d>{{0.0, 30.0}, {-20.0, 50.0}});
  const double u = 1.0 / std::sqrt(2.0);
  for (double s = 0.025; s < 20.0; s += 0.05) {
    for (double z = 0.625; z < 2.0; z += 0.05) {
      for (const double y : {-0.3, 0.3}) wall.add(-u * (s + y), 30.0 + u * (s - y), z);
    }
  }
  wall.add(-u * (7.0 + 0.2), 30.0 + u * (7.0 - 0.2), 1.7);
  const std::vector<RowCanopy> rows =
      gather_row_canopies(wall.cloud, level_field(), wall.lines, {});
  ASSERT_EQ(rows.size(), 2u);
  const Eigen::Vector3f last = rows[1].points.back();
  EXPECT_LT((last - Eigen::Vector3f(7.0f, 0.2f, 1.7f)).norm(), 1e-4f);
  // Lines are in W.
  EXPECT_EQ(rows[1].line.points_W()[0], Vector2d(1000.0, 2030.0));
  EXPECT_EQ(rows[0].row, 0);
  EXPECT_EQ(rows[1].row, 1);
}

TEST(RowPoints, BodyIsAsWideAsNineteenTwentiethsOfItsPoints) {
  const auto class_beside = [](double share_wide) {
    Wall wall(0.6, 2.0);
    const auto wide = static_cast<int>(share_wide * static_cast<double>(wall.cloud.points.size()));
    for (int k = 0; k < wide; ++k) wall.add(20.0 * (k + 0.5) / wide, k % 2 ? 0.9 : -0.9, 1.7);
    const std::size_t beside = wall.add(5.0, 0.85, 0.8);  // below the body's cut
    gather_row_canopies(wall.cloud, level_field(), wall.lines, {});
    return wall.cloud.classes[beside];
  };
  EXPECT_EQ(class_beside(0.02), PointClass::kLowVegetation);
  EXPECT_EQ(class_beside(0.2), PointClass::kCanopy);
}

TEST(RowPoints, EachLineHasItsOwnReach) {
  Wall wall(0.6, 2.0);
  const std::size_t beside = wall.add(5.0, 1.2, 1.5);
  RowPointOptions options;
  options.spacing_of_m = {2.0};
  gather_row_canopies(wall.cloud, level_field(), wall.lines, options);
  EXPECT_EQ(wall.cloud.classes[beside], PointClass::kOther);
  options.spacing_of_m = {2.5};
  gather_row_canopies(wall.cloud, level_field(), wall.lines, options);
  EXPECT_EQ(wall.cloud.classes[beside], PointClass::kCanopy);
}

}  // namespace
}  // namespace vinerow::mapping::row_points_test
