// What PX4 gets with its start, and what its clock and its earth are.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "controllers/autopilot/frames/firmware_frame.h"
#include "controllers/autopilot/mavlink/status_texts.h"
#include "controllers/autopilot/px4/hil_gps.h"
#include "controllers/autopilot/px4/px4_parameters.h"
#include "controllers/autopilot/px4/px4_start.h"
#include "engine/math/angles.h"
#include "tests/controllers/autopilot/parameter_bench.h"
#include "tests/controllers/support/plant.h"

namespace vinerow::controllers::px4_unit_test {
namespace {

using autopilot_fake::kOrigin;
using autopilot_fake::value_of;
using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

TEST(FirmwareFrame, Px4ProjectsAboutItsOrigin) {
  // The forward projection, by spherical trigonometry: distance and bearing from the origin.
  const FirmwareFrame frame(kOrigin, FirmwareFrame::Receiver::kOursInPx4);
  const PlaceE7 origin = frame.place_of(Vector3d(10.0, 20.0, 0.0));
  for (const Vector3d& place_W : {Vector3d(120.0, -260.0, 3.0), Vector3d(-900.0, 1200.0, 40.0)}) {
    const PlaceE7 place = frame.place_of(place_W);
    const double phi0 = rad_from_deg(1e-7 * origin.latitude);
    const double phi = rad_from_deg(1e-7 * place.latitude);
    const double turn = rad_from_deg(1e-7 * (place.longitude - origin.longitude));
    const double half_phi = std::sin(0.5 * (phi - phi0)), half_turn = std::sin(0.5 * turn);
    const double distance_m =
        2.0 * 6'371'000.0 *
        std::asin(std::sqrt(half_phi * half_phi +
                            std::cos(phi0) * std::cos(phi) * half_turn * half_turn));
    const double bearing = std::atan2(
        std::sin(turn) * std::cos(phi),
        std::cos(phi0) * std::sin(phi) - std::sin(phi0) * std::cos(phi) * std::cos(turn));
    // W's axes are straight: far away the ground falls below its plane.
    const double up_m = LocalFrame(kOrigin).to_geodetic(place_W).altitude_m - kOrigin.altitude_m;
    const Vector3d p_NED(distance_m * std::cos(bearing), distance_m * std::sin(bearing), -up_m);
    const Vector3d p_W = frame.local_to_W(origin, 150.0, p_NED);
    EXPECT_LT((p_W - place_W).norm(), 0.02);
  }
}

TEST(HilGps, HasTheReceiversReading) {
  GnssFix fix;
  fix.valid = true;
  fix.mode = GnssFix::Mode::kFloat;
  fix.latitude_rad = rad_from_deg(45.1234567);
  fix.longitude_rad = rad_from_deg(-9.7654321);
  fix.altitude_m = 151.5;
  fix.v_W = {-3.0, 4.0, 1.0};
  fix.std_m = {0.03, 0.04, 0.1};
  fix.satellites = 20;
  const mavlink::HilGps gps = make_hil_gps(fix, Time{12'345'678'901});
  EXPECT_EQ(gps.fix_type, 5);  // GPS_FIX_TYPE_RTK_FLOAT
  EXPECT_EQ(gps.lat, 451'234'567);
  EXPECT_EQ(gps.lon, -97'654'321);
  EXPECT_EQ(gps.alt, 151'500);
  EXPECT_EQ(gps.vn, 400);
  EXPECT_EQ(gps.ve, -300);
  EXPECT_EQ(gps.vd, -100);
  EXPECT_EQ(gps.vel, 500);
  EXPECT_EQ(gps.cog, 32313);  // to the north-west
  EXPECT_EQ(gps.eph, 5);
  EXPECT_EQ(gps.epv, 10);
  EXPECT_EQ(gps.satellites_visible, 20);
  // 21 June 2024, 10:00:12.345678 UTC.
  EXPECT_EQ(gps.time_usec, 1'718'964'012'345'678u);
  EXPECT_EQ(make_hil_gps(GnssFix{}, Time{}).fix_type, 1);
  EXPECT_EQ(make_hil_gps(GnssFix{}, Time{}).eph, 65535);
}

/// Rotors in the order front left, front right, rear right, rear left; the front right one turns
/// the body to the left.
VehicleDescription quadrotor() {
  VehicleDescription vehicle;
  vehicle.type = "quadrotor";
  vehicle.mass_kg = 2.0;
  Rotorcraft& rotors = vehicle.rotorcraft.emplace();
  rotors.rotors = {
      {{0.2, 0.3}, -1.0}, {{0.2, -0.3}, 1.0}, {{-0.2, -0.3}, -1.0}, {{-0.2, 0.3}, 1.0}};
  rotors.thrust_coefficient_Ns2 = 1e-5;
  rotors.torque_coefficient_Nms2 = 2e-7;
  rotors.max_rotor_radps = 1000.0;
  for (int i = 1; i <= 4; ++i) {
    vehicle.actuators.push_back({fmt::format("rotor_{}_speed_radps", i), "rad/s", 0.0, 1000.0});
  }
  return vehicle;
}

AutopilotContext context_of(const VehicleDescription& vehicle) {
  AutopilotContext context = autopilot_fake::context_of(vehicle, Duration{4'000'000});
  context.folder = "/runs/x/products/drone.autopilot";
  return context;
}

TEST(Px4Parameters, OfACopterFollowFromItsRotors) {
  const VehicleDescription vehicle = quadrotor();
  AutopilotContext context = context_of(vehicle);
  Pose mast;
  mast.p = {0.1, 0.2, 0.3};
  context.sensors = {{"gnss", "gnss", mast}};
  FirmwareParams params;
  params.gnss = "gnss";
  const auto parameters = px4_parameters(params, context);
  // Rotor 0 of PX4 is front right, rotor 2 front left; y is to the right. Ours turns the body left
  // in front right, which is a clockwise rotor: negative.
  EXPECT_EQ(value_of(parameters, "CA_ROTOR0_PX"), 0.2);
  EXPECT_EQ(value_of(parameters, "CA_ROTOR0_PY"), 0.3);
  EXPECT_NEAR(value_of(parameters, "CA_ROTOR0_KM"), -0.02, 1e-12);
  EXPECT_EQ(value_of(parameters, "CA_ROTOR2_PY"), -0.3);
  EXPECT_NEAR(value_of(parameters, "CA_ROTOR2_KM"), 0.02, 1e-12);
  EXPECT_EQ(value_of(parameters, "PWM_MAIN_FUNC1"), 101);
  EXPECT_EQ(value_of(parameters, "PWM_MAIN_FUNC4"), 104);
  EXPECT_EQ(value_of(parameters, "PWM_MAIN_FUNC5"), 0);
  // 2 kg of 40 N.
  EXPECT_NEAR(value_of(parameters, "MPC_THR_HOVER"), 2.0 * 9.80665 / 40.0, 1e-9);
  EXPECT_EQ(value_of(parameters, "IMU_INTEG_RATE"), 250);
  EXPECT_EQ(value_of(parameters, "EKF2_GPS_POS_X"), 0.1);
  EXPECT_EQ(value_of(parameters, "EKF2_GPS_POS_Y"), -0.2);
  EXPECT_EQ(value_of(parameters, "EKF2_GPS_POS_Z"), -0.3);
  EXPECT_EQ(value_of(parameters, "COM_RC_IN_MODE"), 4);
  EXPECT_EQ(px4_airframe(vehicle), 10016);
}

TEST(Px4Parameters, OfARoverFollowFromItsSteering) {
  VehicleDescription skid = test::make_rover_description();
  skid.max_speed_mps = 2.0;
  const auto two_sides = px4_parameters(FirmwareParams{}, context_of(skid));
  EXPECT_EQ(value_of(two_sides, "CA_AIRFRAME"), 6);
  EXPECT_EQ(value_of(two_sides, "PWM_MAIN_FUNC1"), 101);  // left
  EXPECT_EQ(value_of(two_sides, "PWM_MAIN_FUNC2"), 102);
  EXPECT_EQ(value_of(two_sides, "GND_SPEED_TRIM"), 1.5);
  EXPECT_EQ(px4_airframe(skid), 1061);

  VehicleDescription axles = test::make_steered_description();
  axles.min_turning_radius_m = 2.0;
  const auto steered = px4_parameters(FirmwareParams{}, context_of(axles));
  EXPECT_EQ(value_of(steered, "CA_AIRFRAME"), 5);
  EXPECT_EQ(value_of(steered, "PWM_MAIN_FUNC1"), 201);
  EXPECT_EQ(value_of(steered, "PWM_MAIN_FUNC2"), 201);
  EXPECT_EQ(value_of(steered, "PWM_MAIN_REV"), 2) << "the rear axle turns the other way";
  EXPECT_NEAR(value_of(steered, "GND_MAX_ANG"), std::atan(axles.wheeled->wheel_base_m / 2.0),
              1e-12);
  EXPECT_EQ(px4_airframe(axles), 1060);
}

TEST(Px4Parameters, OfAFlyingWingFollowFromItsSpeeds) {
  VehicleDescription wing;
  wing.type = "fixed_wing";
  wing.actuators = {{"throttle", "", 0.0, 1.0},
                    {"elevon_left_rad", "rad", -0.5, 0.5},
                    {"elevon_right_rad", "rad", -0.5, 0.5}};
  FixedWingAircraft& plane = wing.fixed_wing.emplace();
  plane.stall_speed_mps = 10.0;
  plane.cruise_speed_mps = 14.0;
  plane.max_bank_rad = rad_from_deg(35.5);
  const auto parameters = px4_parameters(FirmwareParams{}, context_of(wing));
  EXPECT_EQ(value_of(parameters, "PWM_MAIN_FUNC1"), 201);  // left elevon
  EXPECT_EQ(value_of(parameters, "PWM_MAIN_FUNC2"), 202);
  EXPECT_EQ(value_of(parameters, "PWM_MAIN_FUNC3"), 101);
  // The left elevon going up rolls to the left, which is negative.
  EXPECT_LT(value_of(parameters, "CA_SV_CS0_TRQ_R"), 0.0);
  EXPECT_GT(value_of(parameters, "CA_SV_CS0_TRQ_P"), 0.0);
  EXPECT_EQ(value_of(parameters, "FW_AIRSPD_STALL"), 10.0);
  EXPECT_EQ(value_of(parameters, "FW_AIRSPD_MIN"), 11.5);
  EXPECT_EQ(value_of(parameters, "FW_AIRSPD_TRIM"), 14.0);
  EXPECT_EQ(value_of(parameters, "FW_R_LIM"), 35.0);
  EXPECT_EQ(value_of(parameters, "CBRK_AIRSPD_CHK"), 162128) << "it has no pitot tube";
  EXPECT_EQ(px4_airframe(wing), 1030);
}

TEST(Px4Start, HasItsFilesItsFrameAndItsParameters) {
  const VehicleDescription vehicle = quadrotor();
  FirmwareParams params;
  params.instance = 3;
  params.command = {"/opt/px4/bin/px4"};
  EXPECT_THAT(px4_command(params), ElementsAre("/opt/px4/bin/px4", "-i", "3", "-d", "-s",
                                               "etc/init.d-posix/rcS", "/opt/px4/etc"));
  params.command = {"wrapper", "--number={instance}"};
  EXPECT_THAT(px4_command(params), ElementsAre("wrapper", "--number=3"));
  EXPECT_EQ(px4_port_of(params), 4563);
  EXPECT_EQ(px4_mavlink_port_of(params), 14543);
  // The first folder of PATH has the script that PX4's own reads.
  const auto variables = px4_environment(params, context_of(vehicle));
  ASSERT_EQ(variables.size(), 3u);
  EXPECT_THAT(variables[0], ::testing::StartsWith("PATH=/runs/x/products/drone.autopilot:"));
  EXPECT_EQ(variables[1], "PX4_SYS_AUTOSTART=10016");
  EXPECT_EQ(variables[2], "PX4_SIM_HOST_ADDR=127.0.0.1");
  params.parameters = {{"NAV_ACC_RAD", 2.5}, {"COM_DISARM_LAND", -1}};
  const std::string script = px4_parameter_script(params, context_of(vehicle));
  EXPECT_THAT(script, HasSubstr("\nparam set NAV_ACC_RAD 2.5\n"));
  EXPECT_THAT(script, EndsWith("\nparam set COM_DISARM_LAND -1\n"));
  EXPECT_EQ(script.find("NAV_ACC_RAD 0.5"), std::string::npos);
}

mavlink::StatusText piece(std::uint16_t id, std::uint8_t number, const std::string& text) {
  mavlink::StatusText message;
  message.severity = 4;
  message.id = id;
  message.chunk_seq = number;
  mavlink::set_text(message.text, text);
  return message;
}

std::vector<std::string> words_of(const std::vector<SpokenText>& texts) {
  std::vector<std::string> words;
  for (const SpokenText& text : texts) words.push_back(text.text);
  return words;
}

TEST(StatusTexts, PiecesBecomeOneSentence) {
  const std::string fifty(50, 'x');
  StatusTexts texts;
  EXPECT_THAT(words_of(texts.take(piece(0, 0, "short"))), ElementsAre("short"));
  EXPECT_THAT(words_of(texts.take(piece(0, 0, fifty))), ElementsAre(fifty));
  EXPECT_THAT(words_of(texts.take(piece(7, 0, fifty))), ElementsAre());
  EXPECT_THAT(words_of(texts.take(piece(7, 1, fifty))), ElementsAre());
  EXPECT_THAT(words_of(texts.take(piece(7, 2, "end"))), ElementsAre(fifty + fifty + "end"));
  // A lost piece ends the sentence; what follows stands for itself.
  EXPECT_THAT(words_of(texts.take(piece(8, 0, fifty))), ElementsAre());
  EXPECT_THAT(words_of(texts.take(piece(8, 2, "end"))), ElementsAre(fifty, "end"));
  EXPECT_THAT(words_of(texts.take(piece(9, 0, fifty))), ElementsAre());
  EXPECT_THAT(words_of(texts.take(piece(0, 0, "other"))), ElementsAre(fifty, "other"));
}

}  // namespace
}  // namespace vinerow::controllers::px4_unit_test
