/// Which row is nearest, against a search by hand, and which rows lie beside a vehicle.

#include "vehicles/payloads/worked_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/core/random.h"
#include "engine/math/angles.h"

namespace vinerow::vehicles::row_lines_test {
namespace {

using Eigen::Vector2d;

/// Arcs around the origin, 2.5 m apart, on ground that rises with x.
std::vector<PlantRow> curved_rows() {
  std::vector<PlantRow> rows;
  for (int i = 0; i < 6; ++i) {
    PlantRow row;
    row.id = i;
    for (int k = 0; k <= 40; ++k) {
      const double angle = 0.02 * k, radius = 30.0 + 2.5 * i;
      const double x = radius * std::cos(angle);
      row.line_W.emplace_back(x, radius * std::sin(angle), 0.1 * x);
    }
    rows.push_back(row);
  }
  return rows;
}

TEST(RowLines, FindsTheNearestRowAsASearchByHandDoes) {
  const std::vector<PlantRow> rows = curved_rows();
  const RowLines lines(rows);
  RandomStream random(3, "", "test");
  for (int n = 0; n < 2000; ++n) {
    const Vector2d p(random.uniform(10.0, 60.0), random.uniform(-10.0, 45.0));
    int nearest = 0;
    double min_m = std::numeric_limits<double>::infinity();
    for (const PlantRow& row : rows) {
      for (std::size_t i = 0; i + 1 < row.line_W.size(); ++i) {
        const Vector2d a = row.line_W[i].head<2>(), edge = row.line_W[i + 1].head<2>() - a;
        const double share = std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
        const double distance = (p - a - share * edge).norm();
        if (distance < min_m) min_m = distance, nearest = row.id;
      }
    }
    const RowPlace at = lines.nearest(p);
    ASSERT_NEAR(at.distance_m, min_m, 1e-12);
    ASSERT_EQ(at.row, nearest);
  }
}

TEST(RowLines, TellsAlongLateralAndGround) {
  const RowLines lines(curved_rows());
  const double radius = 35.3, angle = 0.43;  // 0.3 m outside of row 2
  const RowPlace at = lines.nearest(radius * Vector2d(std::cos(angle), std::sin(angle)));
  EXPECT_EQ(at.row, 2);
  // The chords of 0.7 m lie up to 1.75 mm inside the arc.
  EXPECT_NEAR(at.lateral_m, -0.3, 2e-3);
  EXPECT_NEAR(at.along_m, 35.0 * angle, 5e-3);
  EXPECT_NEAR(at.ground_m, 0.1 * 35.0 * std::cos(angle), 1e-3);
}

TEST(RowLines, GoesStraightOnBeyondTheEnds) {
  const RowLines lines({{0, {{0, 0, 1}, {10, 0, 2}}, 0.6, 0.5, 2.0}});
  const RowPlace before = lines.nearest({-2.0, 0.5}), behind = lines.nearest({13.0, -0.5});
  EXPECT_EQ(before.along_m, -2.0);
  EXPECT_EQ(before.lateral_m, 0.5);
  EXPECT_EQ(before.ground_m, 1.0);
  EXPECT_NEAR(before.distance_m, std::hypot(2.0, 0.5), 1e-12);
  EXPECT_EQ(behind.along_m, 13.0);
  EXPECT_EQ(behind.lateral_m, -0.5);
  EXPECT_EQ(behind.ground_m, 2.0);
}

TEST(RowLines, KnowsLeftFromRightInBothDirections) {
  const RowLines lines({{0, {{0, 0, 0}, {10, 0, 0}}, 0.6, 0.5, 2.0},
                        {1, {{10, 2.5, 0}, {0, 2.5, 0}}, 0.6, 0.5, 2.0}});  // runs the other way
  const AdjacentRows east = lines.adjacent({5.0, 1.0}, 0.0, 2.0, 0.3, 0.0);
  ASSERT_TRUE(east.left && east.right);
  EXPECT_EQ(east.left->row, 1);
  EXPECT_EQ(east.right->row, 0);
  const AdjacentRows west = lines.adjacent({5.0, 1.0}, kPi, 2.0, 0.3, 0.0);
  ASSERT_TRUE(west.left && west.right);
  EXPECT_EQ(west.left->row, 0);
  EXPECT_EQ(west.right->row, 1);
}

TEST(RowLines, NothingIsBesideAVehicleThatTurnsIsFarOrBeyondTheEnd) {
  const RowLines lines({{0, {{0, 0, 0}, {10, 0, 0}}, 0.6, 0.5, 2.0}});
  const auto count = [&](const Vector2d& p, double heading_rad, double beyond_m = 0.0) {
    const AdjacentRows found = lines.adjacent(p, heading_rad, 2.0, rad_from_deg(20.0), beyond_m);
    return found.left.has_value() + found.right.has_value();
  };
  EXPECT_EQ(count({5.0, 1.0}, rad_from_deg(19.0)), 1);
  EXPECT_EQ(count({5.0, 1.0}, rad_from_deg(21.0)), 0);
  EXPECT_EQ(count({5.0, 1.9}, 0.0), 1);
  EXPECT_EQ(count({5.0, 2.1}, 0.0), 0);
  EXPECT_EQ(count({10.1, 1.0}, 0.0), 0);
  EXPECT_EQ(count({10.1, 1.0}, 0.0, 0.2), 1);
  EXPECT_EQ(count({9.9, 1.0}, 0.0, -0.2), 0);
}

}  // namespace
}  // namespace vinerow::vehicles::row_lines_test
