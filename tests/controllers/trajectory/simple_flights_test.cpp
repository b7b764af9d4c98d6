// Plans of ground vehicles in the air, and hovering, point by point.

#include "controllers/trajectory/simple_flights.h"

#include <gtest/gtest.h>

namespace vinerow::test::simple_flights_test {
namespace {

using Eigen::Vector3d;

struct Expected {
  Vector3d p_W;
  PathKind kind;
};

void expect_points(const PlannedPath& plan, const std::vector<Expected>& expected) {
  ASSERT_EQ(plan.points.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_NEAR((plan.points[k].p_W - expected[k].p_W).norm(), 0.0, 1e-12) << "point " << k;
    EXPECT_EQ(plan.points[k].kind, expected[k].kind) << "point " << k;
  }
}

/// Two legs with a turn on rising ground.
PlannedPath ground_plan() {
  PlannedPath plan;
  for (const Expected& at :
       {Expected{{10, 0, 1}, PathKind::kLeg}, Expected{{20, 0, 2}, PathKind::kTurn},
        Expected{{20, 3, 2.5}, PathKind::kLeg}, Expected{{10, 3, 1.5}, PathKind::kLeg}}) {
    PathPoint point;
    point.p_W = at.p_W;
    point.kind = at.kind;
    point.curvature_per_m = 0.01 * at.p_W.x();
    point.speed_mps = 2.0;
    plan.points.push_back(point);
  }
  return plan;
}

TEST(SimpleFlights, APlanIsFlownAtItsHeightAboveTheGround) {
  const PlannedPath flight = controllers::lift_plan(ground_plan(), {4, -2, 0.7}, 2.0, 0.22);
  expect_points(flight, {{{4, -2, 0.7}, PathKind::kVertical},
                         {{4, -2, 3.0}, PathKind::kTransit},
                         {{10, 0, 3.0}, PathKind::kLeg},
                         {{20, 0, 4.0}, PathKind::kTurn},
                         {{20, 3, 4.5}, PathKind::kLeg},
                         {{10, 3, 3.5}, PathKind::kVertical},
                         {{10, 3, 1.72}, PathKind::kVertical}});
  EXPECT_EQ(flight.points[3].curvature_per_m, 0.2);
  EXPECT_EQ(flight.points[3].speed_mps, 2.0);
}

TEST(SimpleFlights, AVehicleAtTheFirstPointClimbsStraightToIt) {
  const auto points_from = [](double x) {
    return controllers::lift_plan(ground_plan(), {x, 0, 1.2}, 2.0, 0.22).points.size();
  };
  EXPECT_EQ(points_from(10.04), 6u);
  EXPECT_EQ(points_from(10.06), 7u);
}

TEST(SimpleFlights, AHoverGoesUpAcrossAndDown) {
  expect_points(controllers::make_hover_plan({1, 2, 0.3}, {4, 6, 5}),
                {{{1, 2, 0.3}, PathKind::kVertical},
                 {{1, 2, 5}, PathKind::kTransit},
                 {{4, 6, 5}, PathKind::kVertical},
                 {{4, 6, 0.3}, PathKind::kVertical}});
}

TEST(SimpleFlights, AHoverAboveTheStartGoesUpAndDown) {
  expect_points(controllers::make_hover_plan({1, 2, 0.3}, {1.03, 2.03, 5}),
                {{{1, 2, 0.3}, PathKind::kVertical},
                 {{1, 2, 5}, PathKind::kVertical},
                 {{1, 2, 0.3}, PathKind::kVertical}});
}

TEST(SimpleFlights, OnlyPlansOfFlightsHaveVerticals) {
  EXPECT_FALSE(controllers::has_vertical(PlannedPath{}));
  EXPECT_FALSE(controllers::has_vertical(ground_plan()));
  PlannedPath plan = ground_plan();
  plan.points[2].kind = PathKind::kVertical;
  EXPECT_TRUE(controllers::has_vertical(plan));
}

}  // namespace
}  // namespace vinerow::test::simple_flights_test
