/// Paths against rows: the canopy, and what stands on the rows' centre lines.

#include "controllers/planning/routes/row_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/map.h"
#include "engine/api/messages/path.h"
#include "engine/math/angles.h"
#include "tests/controllers/support/mission.h"

namespace vinerow::test::row_check_test {
namespace {

using Eigen::Vector2d;

/// A line of 20 m in a direction, beside the origin: to the left for a positive offset.
std::vector<Eigen::Vector3d> line(double yaw_rad, double offset_m) {
  const Vector2d along(std::cos(yaw_rad), std::sin(yaw_rad)), left(-along.y(), along.x());
  const Vector2d a = -10.0 * along + offset_m * left, b = 10.0 * along + offset_m * left;
  return {{a.x(), a.y(), 0.0}, {b.x(), b.y(), 0.0}};
}

/// Of a path through the origin and a row beside it, for a vehicle of 3 m by 0.6 m.
std::optional<std::string> fault_of(double path_yaw_rad, double row_yaw_rad, double offset_m) {
  RowMap map;
  PlantRow& row = map.rows.emplace_back();
  row.line_W = line(row_yaw_rad, offset_m);
  row.canopy_width_m = 0.1;
  PlannedPath path;
  for (const Eigen::Vector3d& p_W : line(path_yaw_rad, 0.0)) path.points.emplace_back().p_W = p_W;
  VehicleDescription vehicle = make_rover_description();
  vehicle.footprint_B = {{-1.5, -0.3}, {1.5, -0.3}, {1.5, 0.3}, {-1.5, 0.3}};
  return controllers::find_path_into_row(path, map, 0.0, &vehicle);
}

TEST(RowCheck, AnOutlineBesideARowOfItsOwnDirectionIsFreeBeyondHalfItsWidth) {
  for (const double yaw_deg : {0.0, 30.0, 45.0, 120.0, -70.0}) {
    const double yaw = rad_from_deg(yaw_deg);
    for (const double side : {-1.0, 1.0}) {
      EXPECT_FALSE(fault_of(yaw, yaw, side * 0.31)) << yaw_deg;
      const auto fault = fault_of(yaw, yaw, side * 0.29);
      ASSERT_TRUE(fault) << yaw_deg;
      EXPECT_NE(fault->find("where the vehicle's outline touches row"), std::string::npos);
    }
  }
}

TEST(RowCheck, ARowThatCrossesThePathIsMetByTheCanopyFirst) {
  const auto fault = fault_of(0.0, 0.5 * kPi, 0.0);
  ASSERT_TRUE(fault);
  EXPECT_NE(fault->find("from the centre line of row"), std::string::npos);
}

}  // namespace
}  // namespace vinerow::test::row_check_test
