/// The planner as scenarios use it: parameters, whole missions, refusals.

#include <gtest/gtest.h>

#include <cmath>

#include "controllers/planning/routes/rrt_quartile_planner.h"
#include "engine/api/map.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/controllers/planning/search/hand_grids.h"

namespace vinerow::controllers::rrt_quartile_planner_test {
namespace {

using hand_grids::Vineyard;
using Values = std::vector<std::pair<std::string, ParameterSet::Value>>;
using Text = std::string;

struct Mission {
  explicit Mission(const Vineyard& vineyard) {
    map.occupancy = vineyard.make();
    for (int i = 0; i <= vineyard.alleys; ++i) {
      PlantRow row;
      row.id = i;
      row.line_W = {{0, vineyard.row_y(i), 0}, {vineyard.length_m, vineyard.row_y(i), 0}};
      row.canopy_width_m = vineyard.canopy_m;
      map.rows.push_back(row);
    }
    for (int i = 0; i < vineyard.alleys; ++i) {
      const double y = vineyard.alley_y(i);
      map.alleys.push_back({i, {{0, y, 0}, {vineyard.length_m, y, 0}}, 2.5});
    }
    rover.type = "four_wheel_steering_rover";
    rover.footprint_B = hand_grids::rover_outline_B();
    rover.min_turning_radius_m = 1.767;
    rover.wheeled.emplace().wheel_base_m = 1.5;
  }

  std::unique_ptr<Planner> make(const Values& values, std::uint64_t seed = 1) const {
    ParameterSet parameters(rrt_quartile_spec().parameters, "rrt_quartile");
    for (const auto& [name, value] : values) parameters.set(name, value);
    parameters.require_complete();
    PlannerContext context;
    context.vehicle = "rover";
    context.part = "rover.planner";
    context.seed = seed;
    context.vehicle_description = &rover;
    context.map = &map;
    return make_rrt_quartile(parameters, context);
  }

  Result<PlannedPath> plan(const Values& values) const {
    return make(values)->plan({Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.3}});
  }

  std::string refusal(const Values& values) const {
    try {
      make(values);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  }

  RowMap map;
  VehicleDescription rover;
};

Vineyard make_vineyard(int alleys, bool walls = true) {
  Vineyard vineyard;
  vineyard.alleys = alleys;
  vineyard.walls = walls;
  return vineyard;
}

TEST(RrtQuartilePlanner, DrivesEveryAlleyAndReportsItsWork) {
  const Mission mission(make_vineyard(4));
  const std::unique_ptr<Planner> planner = mission.make({});
  const auto path = planner->plan({Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.3}});
  ASSERT_TRUE(path) << path.reason();
  std::vector<int> alleys;
  for (const PathPoint& point : path->points) {
    if (point.alley >= 0 && (alleys.empty() || alleys.back() != point.alley)) {
      alleys.push_back(point.alley);
    }
    EXPECT_LE(std::abs(point.curvature_per_m), (1.0 + 1e-12) / 1.767);
    EXPECT_FALSE(hand_grids::touches(mission.map.occupancy, hand_grids::rover_outline_B(),
                                     {point.p_W.head<2>(), point.yaw_rad}));
  }
  EXPECT_EQ(alleys, (std::vector<int>{0, 1, 2, 3}));
  ASSERT_NE(planner->report(), nullptr);
  const auto& numbers = planner->report()->numbers;
  EXPECT_EQ(numbers.at("turns"), 3.0);
  EXPECT_GT(numbers.at("nodes"), 3.0);
  EXPECT_GT(numbers.at("iterations"), 0.0);
  EXPECT_NEAR(numbers.at("length_m"), path->length_m, 1e-6);
  EXPECT_GE(numbers.at("turn_clearance_m"), 0.05 - 1e-9);
  EXPECT_FALSE(planner->report()->tree.points_W.empty());
}

TEST(RrtQuartilePlanner, OneAlleyMoreChangesNoOtherTurn) {
  const Mission mission(make_vineyard(4));
  const auto longer = mission.plan({{"smooth", false}});
  const auto shorter = mission.plan({{"smooth", false}, {"alleys", std::vector<double>{0, 1, 2}}});
  ASSERT_TRUE(longer && shorter);
  ASSERT_LT(shorter->points.size(), longer->points.size());
  for (std::size_t i = 0; i + 1 < shorter->points.size(); ++i) {
    ASSERT_EQ(shorter->points[i].p_W, longer->points[i].p_W) << i;
  }
}

// Paper A as printed: +-pi/6 on the front axle, 5.0 m between the virtual walls.
TEST(RrtQuartilePlanner, RefusesThePapersTwoWheelTurnWithTheRoomThatIsMissing) {
  const Mission mission(make_vineyard(2));
  const auto path = mission.plan({{"steering", Text("two_wheel")}});
  ASSERT_FALSE(path);
  const std::string& reason = path.reason();
  EXPECT_NE(reason.find("the turn from alley 0 to alley 1 needs 0."), std::string::npos) << reason;
  EXPECT_NE(reason.find("more clearance at the turning radius of 2.60 m"), std::string::npos)
      << reason;
  EXPECT_NE(reason.find("tree exhausted, no sequence of arcs of 2.60 m radius"), std::string::npos)
      << reason;
  EXPECT_TRUE(Mission(make_vineyard(2, false)).plan({{"steering", Text("two_wheel")}}))
      << "without walls there is room";
}

TEST(RrtQuartilePlanner, SteeringAnglesGiveTheCurvatureOfTheirAxles) {
  const auto steepest_per_m = [](const Values& values) {
    const auto path = Mission(make_vineyard(2, false)).plan(values);
    double steepest = 0.0;
    for (const PathPoint& point : path->points) {
      steepest = std::max(steepest, std::abs(point.curvature_per_m));
    }
    return steepest;
  };
  EXPECT_NEAR(steepest_per_m({}), 1.0 / 1.767, 1e-9);
  EXPECT_NEAR(steepest_per_m({{"steering_angle_deg", 18.9}}), 0.456502, 1e-6);  // 2 tan / 1.5
  EXPECT_NEAR(steepest_per_m({{"steering", Text("two_wheel")}}), 0.384900, 1e-6);
  EXPECT_NEAR(steepest_per_m({{"turning_radius_m", 2.0}}), 0.5, 1e-9);
  // 23 deg is the limit behind the vehicle's rounded radius.
  EXPECT_NEAR(steepest_per_m({{"steering_angle_deg", 23.0}}), 0.565966, 1e-6);
}

TEST(RrtQuartilePlanner, RefusesWhatCannotWork) {
  const Mission mission(make_vineyard(2));
  EXPECT_EQ(mission.refusal({{"steering_angle_deg", 30.0}}),
            "rover.planner (rrt_quartile): steering_angle_deg = 30 deg on both axles turns at a "
            "radius of 1.299 m, the vehicle at 1.767 m or more");
  EXPECT_EQ(mission.refusal({{"steering_angle_deg", 20.0}, {"turning_radius_m", 2.0}}),
            "rover.planner (rrt_quartile): give steering_angle_deg or turning_radius_m, not both");
  EXPECT_EQ(mission.refusal({{"cell_m", 0.3}}),
            "rover.planner (rrt_quartile): step_m = 0.4 m, must be longer than a cell's diagonal, "
            "0.4243 m (cell_m = 0.3 m)");
  EXPECT_NE(mission.refusal({{"heuristic", Text("manhattan")}}).find("heuristic"),
            std::string::npos);
  // Ten million nodes took 2.5 GB.
  EXPECT_NE(mission.refusal({{"max_iterations", std::int64_t{2'000'001}}})
                .find("max_iterations = 2000001, must be >= 1 and <= 2000000"),
            std::string::npos);
  EXPECT_EQ(mission.refusal({}), "accepted");

  Mission blank(make_vineyard(2));
  blank.map.occupancy = {};
  EXPECT_NE(blank.refusal({}).find("no occupancy grid"), std::string::npos);
  Mission stiff(make_vineyard(2));
  stiff.rover.wheeled->wheel_base_m = 0.0;
  EXPECT_EQ(stiff.refusal({}), "accepted") << "the turning radius is enough";
  EXPECT_NE(stiff.refusal({{"steering", Text("two_wheel")}}).find("wheel_base_m"),
            std::string::npos);
  stiff.rover.wheeled.reset();
  EXPECT_NE(stiff.refusal({{"steering", Text("two_wheel")}}).find("needs a vehicle with wheels"),
            std::string::npos);
}

}  // namespace
}  // namespace vinerow::controllers::rrt_quartile_planner_test
