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

TEST(RowLines, TheNearestOfEachSideIsAmongAllRows) {
  constexpr double kReach_m = 2.0, kMaxAngle_rad = 0.35;
  for (const double spacing_m : {2.5, 0.1}) {  // two rows within reach, or forty
    // Slanting, with a bend in the middle, of different lengths.
    std::vector<PlantRow> rows;
    for (int i = 0; i < 45; ++i) {
      const Eigen::Vector3d along(0.8, 0.6, 0.0),
          start = i * spacing_m * Eigen::Vector3d(-0.6, 0.8, 0.0);
      rows.push_back({i,
                      {start, start + 6.0 * along,
                       start + (12.0 + 0.1 * i) * Eigen::Vector3d(0.7, 0.714, 0.0)},
                      0.6,
                      0.5,
                      2.0});
    }
    const RowLines lines(rows);
    RandomStream random(4, "", "test");
    int pairs = 0;
    for (int n = 0; n < 2000; ++n) {
      const Vector2d p(random.uniform(-70.0, 15.0), random.uniform(-5.0, 100.0));
      const Vector2d q =
          n % 2 == 0 ? p : Vector2d(random.uniform(-8.0, 12.0), random.uniform(0.0, 14.0));
      const double heading_rad = 0.65 + random.uniform(-0.5, 0.5) + (n % 3 == 0 ? kPi : 0.0);
      const double beyond_m = random.uniform(-0.5, 1.5);
      // By the definition: the row's straight extension is within reach and its end near enough.
      int left = -1, right = -1;
      double left_m = kReach_m, right_m = kReach_m;
      const Vector2d ahead(std::cos(heading_rad), std::sin(heading_rad));
      for (int row = 0; row < lines.count(); ++row) {
        const RowPlace at = lines.place(row, q);
        const double along = ahead.dot(at.direction_W);
        if (at.along_m < -beyond_m || at.along_m > lines.length_m(row) + beyond_m ||
            std::abs(along) < std::cos(kMaxAngle_rad)) {
          continue;
        }
        // Positive: the vehicle sees the row on its right.
        const double to_right_m = along > 0.0 ? at.lateral_m : -at.lateral_m;
        if (to_right_m >= 0.0 && to_right_m < right_m) right = row, right_m = to_right_m;
        if (to_right_m < 0.0 && -to_right_m < left_m) left = row, left_m = -to_right_m;
      }
      const AdjacentRows found = lines.adjacent(q, heading_rad, kReach_m, kMaxAngle_rad, beyond_m);
      ASSERT_EQ(found.left ? found.left->row : -1, left) << "at " << q.transpose();
      ASSERT_EQ(found.right ? found.right->row : -1, right) << "at " << q.transpose();
      pairs += left >= 0 && right >= 0;
    }
    EXPECT_GT(pairs, 100);
  }
}

}  // namespace
}  // namespace vinerow::vehicles::row_lines_test
