#include "controllers/planning/flight/mission_route.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "controllers/planning/survey/survey_mission.h"
#include "engine/core/error.h"
#include "engine/io/missions/qgc_plan.h"
#include "engine/io/missions/qgc_wpl.h"
#include "engine/math/angles.h"
#include "engine/math/geo.h"
#include "tests/controllers/support/mission.h"
#include "tests/support/data.h"
#include "tests/support/plain_scene.h"

namespace vinerow::test::mission_route_test {
namespace {

using Eigen::Vector2d;

VehicleDescription plane() {
  VehicleDescription vehicle;
  vehicle.type = "fixed_wing";
  vehicle.min_turning_radius_m = 21.0;
  vehicle.fixed_wing.emplace().stall_speed_mps = 8.4;
  return vehicle;
}

VehicleDescription quadrotor() {
  VehicleDescription vehicle;
  vehicle.type = "quadrotor";
  vehicle.rotorcraft.emplace();
  vehicle.height_above_ground_m = 0.2;
  return vehicle;
}

struct MissionFlight {
  std::string file;
  GeoOrigin origin{rad_from_deg(47.3977507), rad_from_deg(8.5456075), 488.0};
  VehicleDescription vehicle = plane();
  Pose start{Eigen::Quaterniond::Identity(), {0, 0, 0.0}};
  Values values = {};
  const SceneQuery* scene = nullptr;
};

std::unique_ptr<Planner> make(const MissionFlight& setup) {
  PlannerContext context;
  context.part = "plane.planner";
  context.vehicle_description = &setup.vehicle;
  context.origin = setup.origin;
  context.scene = setup.scene;
  Values values = setup.values;
  values.emplace_back("file", setup.file);
  const PartSpec spec = controllers::mission_route_spec();
  return controllers::make_mission_route(make_parameters(spec, values), context);
}

PlannedPath plan(const MissionFlight& setup) {
  const auto planner = make(setup);
  auto path = planner->plan(setup.start);
  EXPECT_TRUE(path.ok()) << (path ? "" : path.reason());
  return path ? *path : PlannedPath{};
}

std::string refusal(const MissionFlight& setup) {
  try {
    const auto path = make(setup)->plan(setup.start);
    return path ? "none" : path.reason();
  } catch (const ConfigError& e) {
    return e.what();
  }
}

std::string kinds_of(const PlannedPath& path) {
  std::string kinds;
  for (const PathPoint& point : path.points) kinds += "LTtVR"[static_cast<int>(point.kind)];
  return kinds;
}

std::string write_items(const std::vector<io::MissionItem>& items) {
  io::MissionFile mission;
  mission.planned_home = Geodetic{rad_from_deg(47.3977507), rad_from_deg(8.5456075), 488.0};
  mission.items = items;
  const auto file = std::filesystem::temp_directory_path() /
                    (std::string("vinerow_route_") +
                     ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".plan");
  io::write_qgc_plan(mission, file);
  return file;
}

io::MissionItem at(int command, double east_m, double north_m, double altitude_m, int frame = 3) {
  const LocalFrame frame_W(MissionFlight().origin);
  const Geodetic g = frame_W.to_geodetic({east_m, north_m, 0.0});
  return {command,
          frame,
          {0, 0, 0, std::nan(""), deg_from_rad(g.latitude_rad), deg_from_rad(g.longitude_rad),
           altitude_m}};
}

const std::string kSamples = "mavsdk/cpp/src/mavsdk/plugins/mission_raw/test_plans/";

TEST(MissionRoute, FliesTheSampleOfQGroundControl) {
  VINEROW_OUTSIDE_DATA(file, kSamples + "qgroundcontrol_sample.plan");
  MissionFlight setup{file};
  setup.start.p = {-300, 0, 0};  // far enough to climb 50 m at 12 % in one lap or so
  const PlannedPath path = plan(setup);
  const auto& end = path.points;
  // The last places are the three waypoints and home again.
  ASSERT_GE(end.size(), 6u);
  const std::size_t n = end.size();
  EXPECT_NEAR((end[n - 1].p_W - Eigen::Vector3d(-300, 0, 50)).norm(), 0.0, 1e-6);
  // 47.39827842 north of 47.3977507 by 58.7 m (111.19 km a degree), the take-off at the origin.
  EXPECT_NEAR(end[n - 2].p_W.y(), 58.67, 0.1);
  EXPECT_NEAR(end[n - 2].p_W.x(), 0.05, 0.1);
  EXPECT_NEAR(end[n - 4].p_W.x(), 75.85, 0.1);
  for (std::size_t i = n - 5; i < n; ++i) EXPECT_NEAR(end[i].p_W.z(), 50.0, 1e-6);
  for (std::size_t i = 1; i < n; ++i) {
    const Eigen::Vector3d displacement = end[i].p_W - end[i - 1].p_W;
    EXPECT_LE(displacement.z(), 0.12 * displacement.head<2>().norm() + 1e-6);
    EXPECT_EQ(end[i].speed_mps, 15.0);  // the plan's cruise speed
  }
}

TEST(MissionRoute, FliesTheSurveyOfQGroundControl) {
  VINEROW_OUTSIDE_DATA(file, kSamples + "qgroundcontrol_sample_with_survey.plan");
  MissionFlight setup{file};
  setup.origin.latitude_rad = rad_from_deg(47.3977);
  setup.origin.longitude_rad = rad_from_deg(8.5462);
  setup.start.p = {600, 0, 0};
  const PlannedPath path = plan(setup);
  // To the survey, two transects with the camera on in between, and no way home.
  EXPECT_EQ(kinds_of(path), "tLLLLLLLL");
  EXPECT_EQ(path.points.back().alley, path.points[6].alley);
  EXPECT_NE(path.points[1].alley, path.points[6].alley);
  EXPECT_EQ(make(setup)->plan(setup.start).value().points.size(), 9u);
}

TEST(MissionRoute, FliesTheTextOfMissionPlannerAndKeepsFences) {
  VINEROW_OUTSIDE_DATA(text, kSamples + "mission_planner_sample.txt");
  MissionFlight setup{text};
  setup.origin.altitude_m = 5.0;  // frame 5: above mean sea level
  setup.vehicle = quadrotor();
  const PlannedPath path = plan(setup);
  EXPECT_EQ(kinds_of(path), "VtLLRVV");
  EXPECT_NEAR(path.points[1].p_W.z(), 10.0, 1e-3);
  EXPECT_NEAR(path.points.back().p_W.z(), 0.0, 1e-9);  // down to where it stood

  VINEROW_OUTSIDE_DATA(fences, "px4_missions/multicopter_mission_geofence_avoid.plan");
  setup.file = fences;
  setup.origin = MissionFlight().origin;
  setup.vehicle = plane();
  EXPECT_NE(refusal(setup).find("violates exclusion polygon 1 at ("), std::string::npos)
      << refusal(setup);
  setup.values = {{"fences", std::string("ignore")}};
  EXPECT_EQ(refusal(setup), "none");
}

double nearest_m(const PlannedPath& path, const Vector2d& place) {
  double nearest = 1e9;
  for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
    const Vector2d a = path.points[i].p_W.head<2>(), ab = path.points[i + 1].p_W.head<2>() - a;
    const double square = ab.squaredNorm();
    const double share = square > 0.0 ? std::clamp((place - a).dot(ab) / square, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (place - a - share * ab).norm());
  }
  return nearest;
}

/// The fences of PX4's mission in W, read here without the planner's code, by metres a degree.
bool keeps_px4_fences(const Vector2d& p) {
  constexpr double kLat = 47.3977507, kLon = 8.5456075;
  const auto at_degrees = [](double latitude, double longitude) {
    return Vector2d((longitude - kLon) * 75'489.0, (latitude - kLat) * 111'181.0);
  };
  const auto inside = [&](const std::vector<Vector2d>& polygon) {
    bool is_inside = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
      const Vector2d &a = polygon[i], &b = polygon[j];
      if ((a.y() > p.y()) != (b.y() > p.y()) &&
          p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
        is_inside = !is_inside;
      }
    }
    return is_inside;
  };
  return inside({at_degrees(47.39999164, 8.53504774), at_degrees(47.39994510, 8.54544514),
                 at_degrees(47.39274988, 8.55197700), at_degrees(47.39365752, 8.53812459)}) &&
         !inside({at_degrees(47.3991036, 8.5368519), at_degrees(47.3985883, 8.5434353),
                  at_degrees(47.3967667, 8.5442537), at_degrees(47.3968827, 8.5417818)}) &&
         (p - at_degrees(47.39530642, 8.54286778)).norm() > 111.0;
}

TEST(MissionRoute, GoesAroundFencesInTheAirAndOnTheGround) {
  VINEROW_OUTSIDE_DATA(file, "px4_missions/multicopter_mission_geofence_avoid.plan");
  VehicleDescription rover;
  rover.type = "rover";
  rover.wheeled.emplace().track_m = 1.0;
  VehicleDescription steered = rover;
  steered.steered.emplace();
  steered.min_turning_radius_m = 4.0;
  for (const VehicleDescription& vehicle : {quadrotor(), rover, steered}) {
    MissionFlight setup{file};
    setup.vehicle = vehicle;
    const auto planner = make(setup);
    const auto path = planner->plan(setup.start);
    ASSERT_TRUE(path.ok()) << path.reason();
    // The way along the northern polygon alone is barred.
    EXPECT_GE(planner->report()->numbers.at("fence_detours"), 1.0);
    for (std::size_t i = 0; i + 1 < path->points.size(); ++i) {
      const Vector2d a = path->points[i].p_W.head<2>(), b = path->points[i + 1].p_W.head<2>();
      for (int k = 0; k <= 200; ++k) {
        const Vector2d p = a + k / 200.0 * (b - a);
        ASSERT_TRUE(keeps_px4_fences(p)) << p.transpose();
      }
    }
    // Items 2 to 4 at their places, then home. What is rounded passes by R (1/cos - 1) at most.
    const double radius_m = vehicle.steered ? 4.4 : 0.0;
    for (const Vector2d& place : {Vector2d(-84.30, -133.98), Vector2d(-487.12, -155.59)}) {
      EXPECT_LT(nearest_m(*path, place), 0.5 + 2.0 * radius_m) << vehicle.type;
    }
    EXPECT_LT(path->points.back().p_W.head<2>().norm(), 0.5);
  }
}

TEST(MissionRoute, DrivesAtTheItemsSpeedsAndSpraysWhereTheySay) {
  const io::MissionItem slow{178, 2, {1, 0.8, -1, 0, 0, 0, 0}},
      fast{178, 2, {1, 1.5, -1, 0, 0, 0, 0}};
  const io::MissionItem on{216, 2, {1, 0, 0, 0, 0, 0, 0}}, off{216, 2, {0, 0, 0, 0, 0, 0, 0}};
  MissionFlight setup{write_items({slow, at(16, 10, 0, 5), fast, on, at(16, 10, 20, 5), off,
                                   at(16, 30, 20, 5), at(20, 0, 0, 0)})};
  setup.vehicle = VehicleDescription{};
  setup.vehicle.type = "rover";
  setup.vehicle.wheeled.emplace().track_m = 1.0;
  setup.values = {{"waypoint_pitch_m", 1000.0}};
  const PlannedPath path = plan(setup);
  // Start, three places, home. The sprayer works from the first place to the second.
  ASSERT_EQ(path.points.size(), 5u);
  EXPECT_EQ(kinds_of(path).substr(0, 4), "tLtt");
  EXPECT_EQ(path.points[0].speed_mps, 0.8);
  EXPECT_EQ(path.points[1].speed_mps, 1.5);
  EXPECT_NEAR(path.length_m, 10.0 + 20.0 + 20.0 + std::hypot(30.0, 20.0), 0.05);
}

TEST(MissionRoute, RefusesWhatFencesPart) {
  io::MissionFile mission;
  mission.planned_home = Geodetic{rad_from_deg(47.3977507), rad_from_deg(8.5456075), 488.0};
  mission.items = {at(16, 100, 0, 5)};
  const LocalFrame frame(MissionFlight().origin);
  io::FenceCircle around{true, frame.to_geodetic({0.0, 0.0, 0.0}), 50.0};
  around.centre.altitude_m = 0.0;
  mission.fence_circles = {around};
  const auto file = std::filesystem::temp_directory_path() / "vinerow_route_parted.plan";
  io::write_qgc_plan(mission, file);
  MissionFlight setup{file};
  setup.vehicle = VehicleDescription{};
  setup.vehicle.type = "rover";
  setup.vehicle.wheeled.emplace().track_m = 1.0;
  EXPECT_NE(
      refusal(setup).find("no path from the start to item 1 keeps the fences: inclusion circle "
                          "1 at ("),
      std::string::npos)
      << refusal(setup);
}

TEST(MissionRoute, RefusesWhatHasNothingToFly) {
  VINEROW_OUTSIDE_DATA(file, kSamples + "qgroundcontrol_sample_with_digicam_control.plan");
  EXPECT_NE(refusal({file}).find("has no waypoint: there is nowhere to go"), std::string::npos);
}

TEST(MissionRoute, FramesTellWhatHeightsAreMeasuredFrom) {
  MissionFlight setup{write_items({at(16, 900, 0, 50, 3), at(16, 1000, 0, 560, 0),
                                   at(16, 1100, 0, 40, 10), at(16, 1100, 100, 70, 6)})};
  setup.start.p = {0, 0, 3.0};
  const PlannedPath path = plan(setup);  // flat ground 3 m high
  ASSERT_EQ(path.points.size(), 5u);
  EXPECT_NEAR(path.points[1].p_W.z(), 53.0, 1e-6);
  EXPECT_NEAR(path.points[2].p_W.z(), 560.0 - 488.0 - 0.08,
              0.01);  // the Earth falls away: d^2 / 2R
  EXPECT_NEAR(path.points[3].p_W.z(), 43.0, 1e-6);
  EXPECT_NEAR(path.points[4].p_W.z(), 73.0, 1e-6);
}

TEST(MissionRoute, ATakeOffWithoutAPlaceIsWhereTheVehicleStands) {
  // The ground rises by 0.1 to the east and is 30 m high at the start, 32 m at the waypoint.
  const PlainScene scene(GroundPlane{.rise_x = 0.1});
  const auto take_off = [](int frame, double altitude_m) {
    return io::MissionItem{
        22, frame, {0, 0, 0, std::nan(""), std::nan(""), std::nan(""), altitude_m}};
  };
  struct Case {
    int frame;
    double take_off_m, waypoint_m;
  };
  for (const Case& c :
       {Case{0, 488.0 + 40.0, 488.0 + 42.0}, Case{3, 10.0, 12.0}, Case{10, 10.0, 10.0}}) {
    SCOPED_TRACE(c.frame);
    MissionFlight setup{
        write_items({take_off(c.frame, c.take_off_m), at(16, 320, 0, c.waypoint_m, c.frame)})};
    setup.vehicle = quadrotor();
    setup.start.p = {300, 0, 30.2};
    setup.scene = &scene;
    const PlannedPath path = plan(setup);
    ASSERT_EQ(path.points.size(), 3u);
    EXPECT_NEAR(path.points[1].p_W.x(), 300.0, 1e-9);
    EXPECT_NEAR(path.points[1].p_W.z(), 40.0, 0.02);  // the Earth falls away by 1 cm on 320 m
    EXPECT_NEAR(path.points[2].p_W.z(), 42.0, 0.02);
  }
}

TEST(MissionRoute, CountsTheHoldsThatItLeavesOut) {
  io::MissionItem wait = at(16, 900, 0, 50);
  wait.params[0] = 10.0;
  const std::string file = write_items({wait, at(16, 1000, 0, 50)});
  for (const auto& [vehicle, holds] : {std::pair{quadrotor(), 1.0}, {plane(), 0.0}}) {
    MissionFlight setup{file};
    setup.vehicle = vehicle;
    const auto planner = make(setup);
    ASSERT_TRUE(planner->plan(setup.start).ok());
    EXPECT_EQ(planner->report()->numbers.at("ignored_holds"), holds);
  }
}

TEST(MissionRoute, RefusesByNumberAndName) {
  io::MissionItem jump{177, 2, {1, 5, 0, 0, 0, 0, 0}};
  EXPECT_NE(refusal({write_items({at(16, 900, 0, 50), jump})})
                .find("item 2 of '/tmp/vinerow_route_RefusesByNumberAndName.plan', 177 DO_JUMP, "
                      "cannot be flown"),
            std::string::npos);
  MissionFlight far{write_items({at(16, 900, 0, 50)})};
  far.origin.latitude_rad = rad_from_deg(44.7);
  EXPECT_NE(refusal(far).find("km from the world's origin (44.700000, 8.545607), must be within 20 "
                              "km; a world with origin_latitude_deg = 47.39"),
            std::string::npos)
      << refusal(far);
  EXPECT_NE(refusal(far).find("is 299."), std::string::npos) << refusal(far);  // 2.698 deg
  EXPECT_NE(refusal({write_items({at(16, 900, 0, 50), at(16, 1000, 0, -3)})})
                .find("the path from item 1 to item 2 goes"),
            std::string::npos);
  MissionFlight rover{write_items({at(16, 900, 0, 50)})};
  rover.vehicle = VehicleDescription{};
  rover.vehicle.type = "rover";
  EXPECT_NE(refusal(rover).find("vehicle type 'rover' neither flies nor has wheels"),
            std::string::npos);
}

TEST(MissionRoute, LinesBelowTheGroundAreToldHowTheirHeightIsSet) {
  // 200 m to 900 m east of the start at its height; the ground rises by 0.1 on the way.
  const auto file = std::filesystem::temp_directory_path() / "vinerow_route_low.geojson";
  std::ofstream(file)
      << R"({"type":"LineString","coordinates":[[8.54826,47.3977507],[8.55756,47.3977507]]})";
  const PlainScene scene(GroundPlane{.rise_x = 0.1});
  MissionFlight setup{file};
  setup.scene = &scene;
  const std::string text = refusal(setup);
  EXPECT_NE(text.find(" m below the ground at ("), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("; the property height_m of a line or point sets its height")) << text;
  // A file with items has no such property.
  setup.file = write_items({at(16, 200, 0, 0), at(16, 900, 0, 0)});
  EXPECT_EQ(refusal(setup).find("height_m"), std::string::npos) << refusal(setup);
}

TEST(MissionRoute, SpeedsCountFromWhereTheyAreSaid) {
  const io::MissionItem slow{178, 2, {0, 11.0, -1, 0, 0, 0, 0}},
      climb{178, 2, {2, 3.0, -1, 0, 0, 0, 0}};
  const PlannedPath path = plan(
      {write_items({at(16, 900, 0, 50), slow, climb, at(16, 1000, 0, 50), at(16, 1100, 0, 50)})});
  EXPECT_EQ(path.points[0].speed_mps, 15.0);
  EXPECT_EQ(path.points[1].speed_mps, 11.0);
  EXPECT_EQ(path.points[2].speed_mps, 11.0);
}

/// A survey written and read again is the same flight.
TEST(MissionRoute, SurveysComeBackFromBothFormats) {
  controllers::SurveyRequest request;
  request.polygon_W = {{0, 0}, {260, 20}, {240, 300}, {20, 280}};
  const controllers::GroundHeight ground = [](const Vector2d&) {
    return std::optional<double>(-0.2);
  };
  const MissionFlight setup;
  const Pose start{Eigen::Quaterniond::Identity(), {-400, -100, -0.2}};
  const controllers::SurveyPlan survey = controllers::plan_survey(request, start, ground).value();
  io::MissionFile mission = controllers::make_survey_mission(survey, setup.origin, -0.2, true);
  for (const bool text : {false, true}) {
    const auto file = std::filesystem::temp_directory_path() /
                      (text ? "vinerow_survey.waypoints" : "vinerow_survey.plan");
    if (text) {
      io::write_qgc_wpl(mission, file);
    } else {
      io::write_qgc_plan(mission, file);
    }
    MissionFlight again{file};
    again.start = start;
    again.values = {{"climb_slope", 10.0}};  // the survey's own laps are there already
    const PlannedPath path = plan(again);
    ASSERT_EQ(path.points.size(), survey.path.points.size());
    EXPECT_EQ(kinds_of(path), kinds_of(survey.path));
    for (std::size_t i = 0; i < path.points.size(); ++i) {
      EXPECT_NEAR((path.points[i].p_W - survey.path.points[i].p_W).norm(), 0.0, text ? 1e-2 : 1e-3)
          << i;
      EXPECT_EQ(path.points[i].speed_mps, 12.0);
    }
  }
}

/// Fields that QGroundControl needs to treat a plan as that of a multirotor.
TEST(MissionRoute, RotorcraftPlansAreOfAMultirotor) {
  controllers::SurveyRequest request;
  request.polygon_W = {{0, 0}, {60, 0}, {60, 40}, {0, 40}};
  request.height_m = 40.0;
  request.speed_mps = 4.0;
  request.rotorcraft = true;
  const controllers::GroundHeight ground = [](const Vector2d&) {
    return std::optional<double>(0.0);
  };
  const Pose start{Eigen::Quaterniond::Identity(), {-10, -5, 0}};
  const MissionFlight setup;
  const auto survey = controllers::plan_survey(request, start, ground);
  ASSERT_TRUE(survey.ok()) << survey.reason();
  const io::MissionFile mission =
      controllers::make_survey_mission(*survey, setup.origin, 0.0, true);
  const std::string text = io::format_qgc_plan(mission);
  EXPECT_NE(text.find("\"vehicleType\": 2"), std::string::npos);
  EXPECT_NE(text.find("\"hoverSpeed\": 4.0"), std::string::npos);
  ASSERT_GT(mission.items.size(), 6u);
  // Off the ground straight up: to 40 m above the start itself.
  const io::MissionItem& off = mission.items[0];
  EXPECT_EQ(off.command, 22);
  EXPECT_EQ(off.params[0], 0.0);
  // W's up leans by 40 m x 11 m / R = 0.07 mm against the vertical there: 1e-9 deg.
  EXPECT_NEAR(off.params[4], deg_from_rad(mission.planned_home->latitude_rad), 2e-9);
  EXPECT_NEAR(off.params[5], deg_from_rad(mission.planned_home->longitude_rad), 2e-9);
  EXPECT_NEAR(off.params[6], 40.0, 1e-9);
  EXPECT_EQ(mission.items[1].command, 178);
  EXPECT_EQ(mission.items[1].params[0], 1.0) << "speed over ground";
  EXPECT_EQ(mission.items[1].params[1], 4.0);
  const auto count = [&](int command) {
    return std::count_if(mission.items.begin(), mission.items.end(),
                         [&](const io::MissionItem& item) { return item.command == command; });
  };
  EXPECT_EQ(count(206), 2 * static_cast<long>(survey->lanes.size()));
  EXPECT_EQ(count(16), static_cast<long>(survey->path.points.size()) - 2);
  EXPECT_EQ(mission.items.back().command, 20);
}

}  // namespace
}  // namespace vinerow::test::mission_route_test
