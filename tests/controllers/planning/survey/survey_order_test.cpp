#include "controllers/planning/survey/survey_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/core/random.h"

namespace vinerow::test::survey_order_test {
namespace {

controllers::OrderTask even_lanes(int count, double spacing_m, double radius_m) {
  controllers::OrderTask task;
  for (int i = 0; i < count; ++i) task.lanes.push_back({i * spacing_m, 0.0, 300.0});
  task.turn_radius_m = radius_m;
  task.start = task.home = {-50.0, 0.0};
  return task;
}

/// All orders, both directions.
double brute_force_m(const controllers::OrderTask& task) {
  std::vector<int> lanes(task.lanes.size());
  std::iota(lanes.begin(), lanes.end(), 0);
  double best_m = 1e18;
  do {
    for (const bool up : {true, false}) {
      best_m = std::min(best_m, controllers::calc_extra_distance_m(task, lanes, up));
    }
  } while (std::next_permutation(lanes.begin(), lanes.end()));
  return best_m;
}

void expect_every_lane_once(const controllers::OrderTask& task,
                            const controllers::LaneOrder& order) {
  std::vector<int> lanes = order.lanes;
  std::sort(lanes.begin(), lanes.end());
  ASSERT_EQ(lanes.size(), task.lanes.size());
  for (std::size_t i = 0; i < lanes.size(); ++i) ASSERT_EQ(lanes[i], static_cast<int>(i));
  EXPECT_NEAR(order.extra_distance_m,
              controllers::calc_extra_distance_m(task, order.lanes, order.starts_up), 1e-6);
}

TEST(SurveyOrder, IsASnakeWhereTurnsFitBetweenNeighbours) {
  const controllers::OrderTask task = even_lanes(10, 45.0, 21.0);
  const controllers::LaneOrder order = controllers::order_lanes(task);
  EXPECT_TRUE(std::is_sorted(order.lanes.begin(), order.lanes.end()) ||
              std::is_sorted(order.lanes.rbegin(), order.lanes.rend()));
  EXPECT_NEAR(order.extra_distance_m, 9 * 45.0 + 50.0 + std::hypot(50.0, 405.0), 1e-6);
}

TEST(SurveyOrder, SkipsLanesThatAreTooNear) {
  // 26.7 m apart (80 % side overlap), 2 R = 41.9 m: every turn passes a lane at least.
  const controllers::OrderTask task = even_lanes(10, 26.7, 20.95);
  const controllers::LaneOrder order = controllers::order_lanes(task);
  expect_every_lane_once(task, order);
  for (std::size_t i = 1; i < order.lanes.size(); ++i) {
    EXPECT_GE(std::abs(order.lanes[i] - order.lanes[i - 1]), 2);
  }
  // Nine turns of two lanes or more, and one odd step at least to get to the lanes between.
  double distance_m = 0.0;
  for (std::size_t i = 1; i < order.lanes.size(); ++i) {
    distance_m += 26.7 * std::abs(order.lanes[i] - order.lanes[i - 1]);
  }
  EXPECT_GE(distance_m, 26.7 * 19.0 - 1e-6);
  EXPECT_LT(order.extra_distance_m, controllers::order_lanes_as_snake(task).extra_distance_m);
}

TEST(SurveyOrder, EqualsBruteForceOnSmallFields) {
  RandomStream random(7, "survey", "order");
  for (int trial = 0; trial < 24; ++trial) {
    controllers::OrderTask task = even_lanes(3 + trial % 5, 15.0 + 40.0 * random.uniform(), 21.0);
    for (controllers::LaneEnds& lane : task.lanes) {
      lane.low_m -= 150.0 * random.uniform();
      lane.high_m += 150.0 * random.uniform();
    }
    task.start = {600.0 * random.uniform() - 200.0, 600.0 * random.uniform() - 200.0};
    task.home = {600.0 * random.uniform() - 200.0, 600.0 * random.uniform() - 200.0};
    const controllers::LaneOrder order = controllers::order_lanes(task);
    expect_every_lane_once(task, order);
    EXPECT_NEAR(order.extra_distance_m, brute_force_m(task), 1e-5) << trial;
  }
}

/// The heuristic of large fields, judged by the exact order of fields of 10 to 14 lanes.
TEST(SurveyOrder, ImprovedPatternsComeNearTheBest) {
  double worst = 1.0, sum = 0.0;
  int count = 0;
  for (int lanes = 10; lanes <= 13; ++lanes) {
    for (const double spacing_m : {10.0, 15.0, 22.0, 30.0}) {
      const controllers::OrderTask task = even_lanes(lanes, spacing_m, 21.0);
      const controllers::LaneOrder improved = controllers::order_lanes_by_improvement(task);
      expect_every_lane_once(task, improved);
      const double ratio =
          improved.extra_distance_m / controllers::order_lanes_exactly(task).extra_distance_m;
      EXPECT_GE(ratio, 1.0 - 1e-9);
      worst = std::max(worst, ratio);
      sum += ratio;
      ++count;
    }
  }
  RecordProperty("worst", std::to_string(worst));
  printf("added way, improved over exact: mean %.4f, worst %.4f\n", sum / count, worst);
  EXPECT_LT(worst, 1.08);
  EXPECT_LT(sum / count, 1.02);
}

TEST(SurveyOrder, LargeFieldsAvoidWideTurns) {
  for (const int count : {30, 61}) {
    const controllers::OrderTask task = even_lanes(count, 15.0, 21.0);
    const controllers::LaneOrder order = controllers::order_lanes(task);
    expect_every_lane_once(task, order);
    for (std::size_t i = 1; i < order.lanes.size(); ++i) {
      EXPECT_GE(std::abs(order.lanes[i] - order.lanes[i - 1]), 3);
    }
    // No order can do with less than three lanes a turn.
    EXPECT_LT(order.extra_distance_m, 1.25 * (count - 1) * 3 * 15.0 + 50.0 + count * 15.0);
  }
}

TEST(SurveyOrder, AFewNearLanesTakeWideTurns) {
  const controllers::OrderTask task = even_lanes(2, 20.0, 21.0);
  EXPECT_TRUE(controllers::is_wide_turn(task.lanes[0], task.lanes[1], 21.0));
  EXPECT_NEAR(controllers::calc_turn_length_m(task.lanes[0], task.lanes[1], true, 21.0),
              20.0 + 8 * 21.0, 1e-9);
  expect_every_lane_once(task, controllers::order_lanes(task));
  expect_every_lane_once(even_lanes(1, 20.0, 21.0),
                         controllers::order_lanes(even_lanes(1, 20.0, 21.0)));
}

}  // namespace
}  // namespace vinerow::test::survey_order_test
