// What goes to a firmware and comes from it: frames by closed form, missions and parameters by
// their definitions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "controllers/autopilot/ardupilot/start_command.h"
#include "controllers/autopilot/frames/body_state.h"
#include "controllers/autopilot/frames/firmware_frame.h"
#include "controllers/autopilot/mavlink/gps_input.h"
#include "controllers/autopilot/mavlink/parameter_file.h"
#include "engine/core/error.h"
#include "engine/io/missions/mission_items.h"
#include "engine/io/missions/plan_mission.h"
#include "engine/math/angles.h"
#include "engine/math/geo_origin.h"
#include "tests/controllers/autopilot/parameter_bench.h"
#include "tests/controllers/support/plant.h"
#include "tests/support/folder_test.h"

namespace vinerow::controllers::firmware_exchange_test {
namespace {

using autopilot_fake::kOrigin;
using autopilot_fake::value_of;
using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Receiver = FirmwareFrame::Receiver;

TEST(FirmwareFrame, ItsOwnReceiverLivesOnASphere) {
  const FirmwareFrame frame(kOrigin, Receiver::kOfFirmware);
  EXPECT_EQ(frame.home_text(), "45.000000000000,9.000000000000,150.000,0");
  EXPECT_EQ(frame.place_of(Vector3d::Zero()), (PlaceE7{450'000'000, 90'000'000}));
  // ArduPilot: 0.011131884502145034 m for 1e-7 degrees. 1000 m north are 89832.0 of them, 1000 m
  // east at 45 degrees 127041.7.
  EXPECT_EQ(frame.place_of(Vector3d(0, 1000, 0)).latitude, 450'089'832);
  EXPECT_EQ(frame.place_of(Vector3d(1000, 0, 0)).longitude, 90'127'042);
}

TEST(FirmwareFrame, AWaypointIsReachedWhereTheMapHasIt) {
  // A place of a map, in WGS84, goes to the firmware and comes back as its estimate.
  const LocalFrame wgs84(kOrigin);
  const Vector3d place_W(120.0, -260.0, 3.0);
  for (const Receiver receiver : {Receiver::kOfFirmware, Receiver::kOurs}) {
    const FirmwareFrame frame(kOrigin, receiver);
    const PlaceE7 place = frame.place_of(wgs84.to_geodetic(place_W));
    const PlaceE7 ekf_origin = frame.place_of(Vector3d(10.0, 20.0, 0.0));
    // The firmware's own rule for metres between two places.
    constexpr double kUnit_m = 0.011131884502145034;
    const double mean_rad =
        rad_from_deg(0.5e-7 * (static_cast<double>(place.latitude) + ekf_origin.latitude));
    const Vector3d p_NED(kUnit_m * (place.latitude - ekf_origin.latitude),
                         kUnit_m * std::cos(mean_rad) * (place.longitude - ekf_origin.longitude),
                         -3.0);
    const Vector3d p_W = frame.local_to_W(ekf_origin, 150.0, p_NED);
    EXPECT_NEAR(p_W.x(), place_W.x(), 0.02);
    EXPECT_NEAR(p_W.y(), place_W.y(), 0.02);
    EXPECT_NEAR(p_W.z(), place_W.z(), 0.02);
  }
  // Why it matters: WGS84 and the sphere differ by 0.17 % along a meridian at 45 degrees, where a
  // degree is 111,131.7 m at sea level; 150 m higher it is longer.
  const FirmwareFrame sphere(kOrigin, Receiver::kOfFirmware), ours(kOrigin, Receiver::kOurs);
  const Vector3d north(0, 1000, 0);
  EXPECT_NEAR(sphere.place_of(north).latitude - 450'000'000,
              (ours.place_of(north).latitude - 450'000'000) * (111'131.7 / 111'318.8) *
                  (1.0 + 150.0 / 6.367e6),
              1.0);
}

TEST(FirmwareFrame, AttitudeComesBack) {
  const Eigen::Quaterniond q_WB = Eigen::AngleAxisd(0.7, Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(-0.2, Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(0.1, Vector3d::UnitX());
  const Eigen::Matrix3d R = q_NED_FRD_from(q_WB).toRotationMatrix();
  const double yaw = std::atan2(R(1, 0), R(0, 0)), pitch = std::asin(-R(2, 0)),
               roll = std::atan2(R(2, 1), R(2, 2));
  // 0.7 rad from east to the left is this much from north to the right; nose up in B is negative.
  EXPECT_NEAR(yaw, 0.5 * kPi - 0.7, 1e-12);
  EXPECT_NEAR(pitch, 0.2, 1e-12);
  EXPECT_NEAR(roll, 0.1, 1e-12);
  EXPECT_NEAR(std::abs(q_WB_from_ned(roll, pitch, yaw).dot(q_WB)), 1.0, 1e-12);
}

VehicleDescription rover() {
  return test::make_rover_description();
}

VehicleDescription copter() {
  VehicleDescription vehicle;
  vehicle.type = "quadrotor";
  vehicle.rotorcraft.emplace();
  return vehicle;
}

PathPoint point(double x, double y, double z, PathKind kind = PathKind::kLeg, double speed = 0.0) {
  PathPoint point;
  point.p_W = {x, y, z};
  point.kind = kind;
  point.speed_mps = speed;
  return point;
}

std::vector<int> commands_of(const io::MissionFile& mission) {
  std::vector<int> commands;
  for (const io::MissionItem& item : mission.items) commands.push_back(item.command);
  return commands;
}

TEST(PlanMission, HasAWaypointWhereThePlanBends) {
  // Along a row, round a headland in a half circle of 2 m, and back.
  PlannedPath plan;
  for (int i = 0; i <= 400; ++i) plan.points.push_back(point(0.1 * i, 0, 0));
  for (int i = 1; i <= 60; ++i) {
    const double angle = kPi * i / 60.0;
    plan.points.push_back(
        point(40 + 2 * std::sin(angle), 2 - 2 * std::cos(angle), 0, PathKind::kTurn));
  }
  for (int i = 1; i <= 400; ++i) plan.points.push_back(point(40 - 0.1 * i, 4, 0));

  const LocalFrame frame(kOrigin);
  for (const double tolerance_m : {0.05, 0.2}) {
    const io::MissionFile mission = io::make_plan_mission(plan, rover(), frame, tolerance_m);
    std::vector<Vector3d> corners{plan.points.front().p_W};
    for (const io::MissionItem& item : mission.items) {
      EXPECT_EQ(item.command, 16);
      EXPECT_EQ(item.frame, 3);
      corners.push_back(frame.to_local(io::place_of(item)));
      corners.back().z() = 0.0;
    }
    EXPECT_LT((corners.back() - plan.points.back().p_W).norm(), 0.01);
    // A chord of an arc of radius r and angle a is r (1 - cos(a / 2)) away from it, so a half
    // circle needs at least pi / a chords.
    const double angle = 2.0 * std::acos(1.0 - tolerance_m / 2.0);
    const double chords = std::ceil(kPi / angle);
    EXPECT_GE(static_cast<double>(corners.size()), chords + 2);
    EXPECT_LE(static_cast<double>(corners.size()), 2.0 * chords + 4);
    for (const PathPoint& p : plan.points) {
      double nearest_m = 1e9;
      for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
        const Vector3d leg = corners[i + 1] - corners[i];
        const double t = std::clamp((p.p_W - corners[i]).dot(leg) / leg.squaredNorm(), 0.0, 1.0);
        nearest_m = std::min(nearest_m, (p.p_W - corners[i] - t * leg).norm());
      }
      EXPECT_LE(nearest_m, tolerance_m + 0.01);
    }
  }
}

TEST(PlanMission, RotorcraftTakeOffAndLandWhereThePlanIsVertical) {
  PlannedPath plan;
  plan.points = {point(0, 0, 0.1, PathKind::kVertical), point(0, 0, 4, PathKind::kLeg, 1.5),
                 point(10, 0, 4, PathKind::kLeg, 1.5),  point(10, 5, 4, PathKind::kLeg, 3.0),
                 point(0, 5, 4, PathKind::kVertical),   point(0, 5, 0.1)};
  const io::MissionFile mission = io::make_plan_mission(plan, copter(), LocalFrame(kOrigin), 0.05);
  EXPECT_THAT(commands_of(mission), ElementsAre(22, 178, 16, 16, 178, 16, 21));
  // Above mean sea level: the world's origin is at 150 m.
  EXPECT_EQ(mission.items[0].frame, 0);
  EXPECT_NEAR(mission.items[0].params[6], 154.0, 0.01);
  EXPECT_EQ(mission.items[1].params[1], 1.5);
  EXPECT_EQ(mission.items[4].params[1], 3.0);
  EXPECT_NEAR(mission.items[6].params[6], 150.1, 0.01);
}

TEST(MissionItems, BeginWithHomeAndHaveNoNaN) {
  io::MissionFile mission;
  mission.planned_home = Geodetic{kOrigin.latitude_rad, kOrigin.longitude_rad, 150.0};
  io::MissionItem waypoint;
  waypoint.params = {0, 0, 0, std::nan(""), 45.001, 9.0, 12.0};
  io::MissionItem servo;
  servo.command = 183;
  servo.frame = 2;
  servo.params = {9, 1700, 0, 0, 0, 0, 0};
  mission.items = {waypoint, servo};
  const FirmwareFrame frame(kOrigin, Receiver::kOurs);
  const auto place_of = [&](const Geodetic& point) { return frame.place_of(point); };
  const auto items = io::make_mission_items(mission, mission.planned_home, place_of);
  ASSERT_EQ(items.size(), 3u);
  EXPECT_EQ(items[0].x, 450'000'000);
  EXPECT_EQ(items[0].z, 150.0F);
  EXPECT_EQ(items[1].seq, 1);
  EXPECT_EQ(items[1].x, 450'010'000);
  EXPECT_EQ(items[1].param4, 0.0F);
  EXPECT_EQ(items[1].z, 12.0F);
  EXPECT_EQ(items[2].command, 183);
  EXPECT_EQ(items[2].param2, 1700.0F);
  EXPECT_EQ(io::make_mission_items(mission, std::nullopt).size(), 2u);
}

TEST(GpsInput, HasTheReceiversReading) {
  GnssFix fix;
  fix.valid = true;
  fix.mode = GnssFix::Mode::kFixed;
  fix.latitude_rad = rad_from_deg(45.1234567);
  fix.longitude_rad = rad_from_deg(-9.7654321);
  fix.altitude_m = 151.5;
  fix.v_W = {1.0, 2.0, 3.0};
  fix.std_m = {0.03, 0.04, 0.1};
  fix.satellites = 20;
  const mavlink::GpsInput input = make_gps_input(fix, Time{12'345'678'901});
  EXPECT_EQ(input.fix_type, 6);  // GPS_FIX_TYPE_RTK_FIXED
  EXPECT_EQ(input.lat, 451'234'567);
  EXPECT_EQ(input.lon, -97'654'321);
  EXPECT_EQ(input.alt, 151.5F);
  EXPECT_EQ(input.vn, 2.0F);
  EXPECT_EQ(input.ve, 1.0F);
  EXPECT_EQ(input.vd, -3.0F);
  EXPECT_FLOAT_EQ(input.horiz_accuracy, 0.05F);
  EXPECT_EQ(input.satellites_visible, 20);
  // 21 June 2024, a Friday, 10:00:12.345 UTC; GPS is 18 s ahead.
  EXPECT_EQ(input.time_week, 2319);
  EXPECT_EQ(input.time_week_ms, (5u * 86'400 + 36'000 + 18 + 12) * 1000 + 345);
  EXPECT_EQ(make_gps_input(GnssFix{}, Time{}).fix_type, 1);
}

AutopilotContext context_of(const VehicleDescription& vehicle) {
  return autopilot_fake::context_of(vehicle, Duration{10'000'000});
}

TEST(StartCommand, OfOneWordGetsWhatARepeatableRunNeeds) {
  const VehicleDescription vehicle = rover();
  FirmwareParams params;
  params.command = {"./ardurover"};
  params.instance = 2;
  EXPECT_THAT(start_command(params, context_of(vehicle)),
              ElementsAre("./ardurover", "--wipe", "--model", "JSON:127.0.0.1", "--instance", "2",
                          "--home", "45.000000000000,9.000000000000,150.000,0", "--speedup", "1000",
                          "--start-time", "1718964000", "--serial0", "udpclient:127.0.0.1:14575",
                          "--defaults", "vinerow.parm"));
  params.command = {"wrapper", "-I{instance}", "{mavlink},{mavlink}"};
  params.mavlink_port = 4000;
  EXPECT_THAT(start_command(params, context_of(vehicle)),
              ElementsAre("wrapper", "-I2", "udpclient:127.0.0.1:4000,udpclient:127.0.0.1:4000"));
  params.command = {};
  EXPECT_TRUE(start_command(params, context_of(vehicle)).empty());
  EXPECT_EQ(lockstep_port_of(params), 9022);
}

TEST(VehicleParameters, FollowFromTheVehicleAndTheUserHasTheLastWord) {
  VehicleDescription vehicle = rover();
  vehicle.max_speed_mps = 2.0;
  FirmwareParams params;
  params.gnss = "gps";
  params.ranges = {"left", "down"};
  params.parameters = {{"WP_SPEED", 0.7}, {"RC1_MIN", 1100}};
  AutopilotContext context = context_of(vehicle);
  Pose to_the_left, downwards;
  to_the_left.q = Eigen::AngleAxisd(0.5 * kPi, Vector3d::UnitZ());
  downwards.q = Eigen::AngleAxisd(0.5 * kPi, Vector3d::UnitY());
  context.sensors = {{"left", "ultrasound", to_the_left}, {"down", "ultrasound", downwards}};
  const auto parameters = start_parameters(params, context);
  EXPECT_EQ(value_of(parameters, "LOG_BACKEND_TYPE"), 0);
  EXPECT_EQ(value_of(parameters, "SERVO1_FUNCTION"), 73);
  EXPECT_EQ(value_of(parameters, "SERVO3_FUNCTION"), 74);
  EXPECT_EQ(value_of(parameters, "CRUISE_SPEED"), 1.5);
  EXPECT_EQ(value_of(parameters, "CRUISE_THROTTLE"), 75);
  EXPECT_EQ(value_of(parameters, "GPS1_TYPE"), 14);
  EXPECT_EQ(value_of(parameters, "RNGFND1_TYPE"), 100);
  EXPECT_EQ(value_of(parameters, "RNGFND1_ORIENT"), 6);   // MAV_SENSOR_ROTATION_YAW_270
  EXPECT_EQ(value_of(parameters, "RNGFND2_ORIENT"), 25);  // MAV_SENSOR_ROTATION_PITCH_270
  EXPECT_EQ(value_of(parameters, "WP_SPEED"), 0.7);
  EXPECT_EQ(value_of(parameters, "RC1_MIN"), 1100);
}

struct ParameterFile : test::FolderTest {
  ParameterFile() : FolderTest("parameter_file") {}
};

TEST_F(ParameterFile, ReadsBothForms) {
  const auto write = [&](const char* text) {
    const auto file = folder_ / "x.parm";
    std::ofstream(file) << text;
    return file;
  };
  const auto read = [&](const char* text) {
    return parameter_text(read_parameter_file(write(text)));
  };
  EXPECT_EQ(read("# rover\nWP_SPEED 1.5\nCRUISE_SPEED,2 # m/s\r\n\nWP_SPEED\t3\n"),
            "WP_SPEED 3\nCRUISE_SPEED 2\n");
  EXPECT_EQ(read("# Vehicle-Id Component-Id Name Value Type\n1\t1\tWP_SPEED\t1.25\t9\n"),
            "WP_SPEED 1.25\n");
  const auto fault = [&](const char* text) {
    try {
      read(text);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(fault("WP_SPEED 1\nWP_SPEED fast\n"),
              HasSubstr("x.parm:2: \"WP_SPEED fast\" must be a name of at most 16 characters and a "
                        "number"));
  EXPECT_THAT(fault("A_NAME_THAT_IS_TOO_LONG 1\n"), HasSubstr("x.parm:1: "));
  EXPECT_THAT(fault("WP_SPEED nan\n"), HasSubstr("x.parm:1: "));
  EXPECT_THAT(fault("WP_SPEED\n"), HasSubstr("x.parm:1: "));
}

}  // namespace
}  // namespace vinerow::controllers::firmware_exchange_test
