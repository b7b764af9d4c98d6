#include "controllers/planning/survey/survey.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "engine/api/map.h"
#include "engine/core/error.h"
#include "tests/controllers/support/mission.h"

namespace vinerow::test::survey_test {
namespace {

VehicleDescription plane() {
  VehicleDescription vehicle;
  vehicle.type = "fixed_wing";
  vehicle.min_turning_radius_m = 15.0;
  FixedWingAircraft& aircraft = vehicle.fixed_wing.emplace();
  aircraft.stall_speed_mps = 8.4;
  aircraft.max_bank_rad = 0.7;
  return vehicle;
}

RowMap parcel() {
  RowMap map;
  map.boundary_W = {{0, 0}, {260, 0}, {260, 300}, {0, 300}};
  return map;
}

struct Outcome {
  std::string fault = "none";
  PlannedPath path;
  std::map<std::string, double> numbers;
};

Outcome run(const Values& values, const VehicleDescription& vehicle = plane(),
            const RowMap& map = parcel()) {
  PlannerContext context;
  context.part = "plane.planner";
  context.vehicle_description = &vehicle;
  context.map = &map;
  Outcome outcome;
  try {
    const auto planner =
        controllers::make_survey(make_parameters(controllers::survey_spec(), values), context);
    const auto path = planner->plan({Eigen::Quaterniond::Identity(), {-300, -100, 150}});
    if (path) {
      outcome.path = *path;
    } else {
      outcome.fault = path.reason();
    }
    outcome.numbers = planner->report()->numbers;
  } catch (const ConfigError& e) {
    outcome.fault = e.what();
  }
  return outcome;
}

TEST(SurveyPart, SurveysTheParcelOfTheMap) {
  const Outcome outcome = run({});
  EXPECT_EQ(outcome.fault, "none");
  EXPECT_NEAR(outcome.numbers.at("area_ha"), 7.8, 1e-9);
  EXPECT_EQ(outcome.numbers.at("covered_share"), 1.0);
  EXPECT_EQ(outcome.path.points.front().speed_mps, 12.0);
  EXPECT_NEAR(run({{"margin_m", 20.0}}).numbers.at("area_ha"), 30.0 * 34.0 / 100.0, 1e-9);
  EXPECT_NEAR(run({{"lane_bearing_deg", 30.0}}).numbers.at("lane_bearing_deg"), 30.0, 1e-9);
}

TEST(SurveyPart, GivesHeightsForAGroundSamplingDistance) {
  EXPECT_NEAR(run({{"gsd_m", 0.1}}).numbers.at("height_m"), 144.0, 1e-9);
  EXPECT_NEAR(run({{"gsd_m", 0.041}, {"camera", std::string("rx100")}}).numbers.at("height_m"),
              149.6, 0.1);
}

TEST(SurveyPart, PlansForRotorsWhereTheVehicleHasThem) {
  VehicleDescription drone;
  drone.type = "quadrotor";
  drone.rotorcraft.emplace();
  const Outcome by_vehicle = run({}, drone);
  EXPECT_EQ(by_vehicle.fault, "none");
  EXPECT_EQ(by_vehicle.numbers.at("turn_radius_m"), 0.0);
  // Straight up from the start, and down to it.
  const std::vector<PathPoint>& points = by_vehicle.path.points;
  const Eigen::Vector3d start_W(-300, -100, 150);
  EXPECT_EQ(points.front().p_W, start_W);
  EXPECT_EQ(points.front().kind, PathKind::kVertical);
  EXPECT_NEAR((points[1].p_W - start_W).head<2>().norm(), 0.0, 1e-9);
  EXPECT_NEAR(points[1].p_W.z(), 300.0, 1e-9);  // 150 m above the flat ground that it stands on
  EXPECT_EQ(points[points.size() - 2].kind, PathKind::kVertical);
  EXPECT_NEAR((points.back().p_W - start_W).norm(), 0.0, 1e-9);
  EXPECT_NE(run({{"return_home", false}}, drone).path.points.back().kind, PathKind::kVertical);
  EXPECT_EQ(run({{"rotorcraft", true}}, drone).path.length_m, by_vehicle.path.length_m);
  EXPECT_GT(run({{"rotorcraft", false}}, drone).numbers.at("turn_radius_m"), 1.0);
  EXPECT_EQ(run({{"rotorcraft", false}}, drone).path.points.front().kind, PathKind::kVertical);
  EXPECT_EQ(run({{"rotorcraft", true}}).numbers.at("turn_radius_m"), 0.0);
  EXPECT_NE(run({{"rotorcraft", true}}).path.points.front().kind, PathKind::kVertical);
}

TEST(SurveyPart, RefusesWhileLoading) {
  const auto expect = [](const Values& values, const std::string& text) {
    const Outcome outcome = run(values);
    EXPECT_EQ(outcome.fault.find("plane.planner (survey): "), 0u) << outcome.fault;
    EXPECT_NE(outcome.fault.find(text), std::string::npos) << outcome.fault;
  };
  expect({{"gsd_m", 0.041}}, "at most 5.9 m/s at 59 m (below the stall speed of 8.4 m/s)");
  expect({{"gsd_m", 0.1}, {"height_m", 100.0}}, "give height_m or gsd_m, not both");
  expect({{"bank_deg", 50.0}}, "bank_deg = 50 deg, but vehicle type 'fixed_wing' banks 40.1 deg");
  expect({{"speed_mps", 8.0}}, "must be above the stall speed of 8.4 m/s");
  expect({{"polygon_x_m", std::vector<double>{0, 1}}},
         "polygon_x_m has 2 numbers and polygon_y_m 0");
  expect({{"polygon_x_m", std::vector<double>{0, 90, 90, 0}},
          {"polygon_y_m", std::vector<double>{0, 90, 0, 90}}},
         "crosses its edge from point 3");
  expect({{"margin_m", -140.0}}, "with margin_m = -140 m an edge of the polygon vanishes");
  expect({{"wind_speed_mps", 5.0}, {"wind_from_deg", 180.0}, {"lane_bearing_deg", 0.0}},
         "17.0 m/s over ground (wind from behind)");
  const VehicleDescription flyer = plane();
  EXPECT_NE(run({}, flyer, RowMap{}).fault.find("the map has no parcel boundary"),
            std::string::npos);
  VehicleDescription rover;
  rover.type = "rover";
  EXPECT_NE(run({}, rover).fault.find("does not fly"), std::string::npos);
}

TEST(SurveyPart, TurnsAsTheVehicleCan) {
  VehicleDescription wide = plane();
  wide.min_turning_radius_m = 40.0;
  EXPECT_EQ(run({}, wide).numbers.at("turn_radius_m"), 40.0);
  EXPECT_NEAR(run({}).numbers.at("turn_radius_m"), 20.97, 0.01);
  VehicleDescription gentle = plane();
  gentle.fixed_wing->max_bank_rad = 0.4;
  EXPECT_NEAR(run({}, gentle).numbers.at("turn_radius_m"), 144.0 / (9.80665 * std::tan(0.4)), 1e-9);
}

}  // namespace
}  // namespace vinerow::test::survey_test
