// Vehicles under PX4: a small program that speaks its interface to simulators drives and flies
// them. The expected readings follow from the truth that it gets beside them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/event.h"
#include "engine/api/messages/motion.h"
#include "engine/api/messages/sensors.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/mavlink/enums.h"
#include "tests/controllers/autopilot/fake_px4.h"
#include "tests/controllers/autopilot/fake_vehicle.h"
#include "tests/scenarios/autopilot_support.h"
#include "tests/scenarios/session_support.h"
#include "vinerow/session.h"

namespace vinerow::px4_test {
namespace {

using namespace autopilot_test;
using controllers::FakePx4;
using controllers::FakePx4Options;
using controllers::FakePx4State;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Shares = FakePx4::Shares;

/// Roll, pitch, yaw of FRD in NED, rad.
std::array<double, 3> angles_of(const FakePx4State& state) {
  const auto [w, x, y, z] = state.truth->attitude_quaternion;
  return {std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)), std::asin(2 * (w * y - z * x)),
          std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))};
}

Shares skid(double left, double right) {
  Shares shares{};
  shares[0] = static_cast<float>(left);
  shares[1] = static_cast<float>(right);
  return shares;
}

/// Turns to a course from north and drives half ahead.
Shares hold_course(const FakePx4State& state, double course_rad) {
  if (!state.truth) return {};
  const double turn = std::clamp(0.5 * wrap_angle(course_rad - angles_of(state)[2]), -0.2, 0.2);
  return skid(0.3 + turn, 0.3 - turn);
}

TEST(Px4, DrivesASkidRoverOnACourse) {
  const int instance = free_px4_instance();
  FakePx4 fake(px4_options(instance),
               [](const FakePx4State& state) { return hold_course(state, rad_from_deg(60.0)); });
  Session session = open(px4_rover_text(px4(instance)));
  session.advance(Time{10 * kSecond});
  const Odometry& truth = session.signal<Odometry>("rover/truth").value();
  const Eigen::Vector3d ahead_W = truth.X_WB.q * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(deg_from_rad(std::atan2(ahead_W.x(), ahead_W.y())), 60.0, 3.0);
  EXPECT_GT(truth.v_WB_B.x(), 0.2);
  EXPECT_THAT(fake.complaints(), IsEmpty());
}

TEST(Px4, GetsReadingsThatFitTheTruth) {
  const int instance = free_px4_instance();
  FakePx4 fake(px4_options(instance),
               [](const FakePx4State& state) { return hold_course(state, rad_from_deg(60.0)); });
  // Inertial unit and compass lie on their sides, which must not show in the readings.
  std::string text = px4_rover_text(px4(instance, ", ranges: [sonar], airspeed: pitot"));
  replace(text, "type: imu,", "type: imu, rotation_deg: [0, 0, 90],");
  replace(text, "type: magnetometer,", "type: magnetometer, rotation_deg: [90, 0, 0],");
  replace(text, "sensors: {",
          "sensors: {pitot: {type: air_data, rate_Hz: 20, min_airspeed_mps: 0}, ");
  Session session = open(text);
  session.advance(Time{10 * kSecond});
  const auto states = fake.states_of_run();
  ASSERT_EQ(states.size(), 1001u);  // at 100 Hz, with both ends
  // The clock goes on from the boot by the period.
  EXPECT_EQ(states[0].sensors.time_usec % 4000, 10'000 % 4000);
  EXPECT_EQ(states[1000].sensors.time_usec - states[0].sensors.time_usec, 10'000'000u);

  const FakePx4State& state = states.back();
  const auto& truth = *state.truth;
  const auto [roll, pitch, yaw] = angles_of(state);
  // Accelerometers at an even speed show 1 g upwards, which is negative in FRD, and lean with it.
  EXPECT_NEAR(state.sensors.zacc, -9.80665 * std::cos(roll) * std::cos(pitch), 0.5);
  // The compass points to magnetic north: at 45 N, 9 E it is 3 degrees east of north (World
  // Magnetic Model 2025).
  double heading = 0.0;
  for (auto at = states.rbegin(); heading == 0.0; ++at) {
    if ((at->sensors.fields_updated & 0x1C0) == 0) continue;
    heading = std::atan2(-at->sensors.ymag, at->sensors.xmag);
    EXPECT_NEAR(std::hypot(at->sensors.xmag, at->sensors.ymag, at->sensors.zmag), 0.475, 0.02);
    EXPECT_GT(at->sensors.zmag, 0.3) << "in the north the field points down";
  }
  EXPECT_NEAR(deg_from_rad(wrap_angle(yaw - heading)), 3.3, 1.5);
  // The receiver is where the truth is: 1e-7 degrees are 1.1 cm.
  ASSERT_TRUE(state.gps);
  EXPECT_NEAR(state.gps->lat, truth.lat, 100);
  EXPECT_NEAR(state.gps->lon, truth.lon, 100);
  EXPECT_NEAR(state.gps->alt, truth.alt, 2000);
  EXPECT_NEAR(state.gps->vn, truth.vx, 15);
  EXPECT_NEAR(state.gps->ve, truth.vy, 15);
  EXPECT_EQ(state.gps->fix_type, 3);
  const GnssFix& fix = session.signal<GnssFix>("rover/gps").value();
  EXPECT_NEAR(state.gps->eph, 100.0 * std::hypot(fix.std_m.x(), fix.std_m.y()), 0.51) << "in cm";
  // Pressure at that altitude by the barometric formula.
  for (const FakePx4State& one : states) {
    if ((one.sensors.fields_updated & 0x200) == 0) continue;
    const double altitude_m = 1e-3 * one.truth->alt;
    EXPECT_NEAR(one.sensors.abs_pressure,
                1013.25 * std::pow(1.0 - altitude_m / 44330.77, 1.0 / 0.1902632), 0.5);
    EXPECT_NEAR(one.sensors.pressure_alt, altitude_m, 5.0);
  }
  const RangeSample& sonar = session.signal<RangeSample>("rover/sonar").value();
  const double distance_m = std::min(sonar.range_m, sonar.max_range_m + 1.0);
  const auto ranging = std::find_if(states.rbegin(), states.rend(),
                                    [](const auto& one) { return !one.ranges.empty(); });
  EXPECT_NEAR(ranging->ranges[0].current_distance, 100.0 * distance_m, 0.51) << "in cm";
  EXPECT_EQ(ranging->ranges[0].orientation, 0) << "MAV_SENSOR_ROTATION_NONE: ahead";
  // Dynamic pressure in hPa at 150 m, where the standard's density is 1.2075 kg/m3.
  const double speed_mps = session.signal<AirData>("rover/pitot").value().v_air_B.x();
  const auto flowing = std::find_if(states.rbegin(), states.rend(), [](const auto& one) {
    return (one.sensors.fields_updated & 0x400) != 0;
  });
  EXPECT_GT(speed_mps, 0.2);
  EXPECT_NEAR(flowing->sensors.diff_pressure, 0.005 * 1.2075 * speed_mps * speed_mps, 1e-5);
  // The gyroscope's z axis is down: it agrees with the truth through the turn.
  const FakePx4State& turning = states[60];
  EXPECT_GT(turning.truth->yawspeed, 0.05F);
  EXPECT_NEAR(turning.sensors.zgyro, turning.truth->yawspeed, 0.05);
  // Each reading is sent once: receiver 10 Hz, compass 50 Hz, barometer 25 Hz, sonar 20 Hz.
  const auto count = [&](auto&& is_one) {
    return std::count_if(states.begin(), states.end(), is_one);
  };
  EXPECT_NEAR(count([](const auto& one) { return one.has_new_gps; }), 101, 1);
  EXPECT_NEAR(count([](const auto& one) { return one.sensors.fields_updated & 0x1C0; }), 501, 1);
  EXPECT_NEAR(count([](const auto& one) { return one.sensors.fields_updated & 0x200; }), 251, 1);
  EXPECT_NEAR(count([](const auto& one) { return !one.ranges.empty(); }), 201, 1);
}

TEST(Px4, HasTheSameDigestAtAnyPaceAndInReplay) {
  const test::ScratchFolder folder("px4_replay");
  const auto drive = [&](FakePx4Options manners, bool records) {
    const int instance = free_px4_instance();
    manners.port = px4_options(instance).port;
    FakePx4 fake(manners,
                 [](const FakePx4State& state) { return hold_course(state, rad_from_deg(60.0)); });
    Session session = open(px4_rover_text(px4(instance, records ? ", record: drive.pcap" : "")),
                           folder.path() / "products");
    session.advance(Time{3 * kSecond});
    return session.digest();
  };
  const std::string fast = drive({}, true);
  FakePx4Options slow;
  slow.think_s = 0.002;
  slow.start_after_s = 0.3;
  slow.silent = 40;  // a longer boot
  EXPECT_EQ(drive(slow, false), fast);
  FakePx4Options odd;
  odd.cut_at = 120;
  odd.garbage_at = 140;
  odd.twice_at = 160;
  EXPECT_EQ(drive(odd, false), fast);

  const std::string file = (folder.path() / "products" / "rover.autopilot" / "drive.pcap").string();
  const std::string replay =
      "type: replay, rate_Hz: 100, mavlink: false, file: " + file + kPx4Sensors;
  Session session = open(px4_rover_text(replay));
  session.advance(Time{3 * kSecond});
  EXPECT_EQ(session.digest(), fast);
  std::string other = px4_rover_text(replay);
  replace(other, "turn_deg: 150", "turn_deg: 149");
  EXPECT_THAT(fault_of(other), HasSubstr("of another flight: the states differ from byte "));
}

std::string copter_text(const std::string& autopilot) {
  return R"(
vinerow: 1
name: hover
duration_s: 20
world: {type: vineyard, row_count: 2, row_length_m: 20, relief_m: 0, waves_m: 0, leaf_cards_per_m: 10, plant_variants: 1}
vehicles:
  drone:
    type: quadrotor
    spawn: {alley: 0, offset_m: 4}
    sensors: {)" +
         kPx4SensorList + R"(, gps: {type: gps, rate_Hz: 10, error: gaussian, accuracy_m: 0.1}}
    autopilot: {)" +
         autopilot + "}\n";
}

TEST(Px4, DisarmedItsMotorsAreOffAlsoIfReversed) {
  const int instance = free_px4_instance();
  FakePx4Options options = px4_options(instance);
  options.is_armed = false;
  FakePx4 fake(options, [](const FakePx4State&) { return Shares{}; });
  Session session = open(copter_text(
      px4(instance,
          ", channels: [{function: motor_front_right, output: 1, reversed: true}, {function: "
          "motor_rear_left, output: 2}, {function: motor_front_left, output: 3}, {function: "
          "motor_rear_right, output: 4, reversed: true}]",
          250)));
  session.advance(Time{kSecond});
  for (const double speed : session.signal<NamedValues>("drone/actuators").value().values) {
    EXPECT_EQ(speed, 0.0);
  }
}

TEST(Px4, HoldsAQuadrotorAtAHeight) {
  const int instance = free_px4_instance();
  // The law of autopilot_test.cpp, mixed for PX4's X: 1 front right, 2 rear left, 3 front left,
  // 4 rear right. Our front left and rear right rotors turn counter-clockwise, which turns the body
  // clockwise.
  std::optional<double> start_mm;
  FakePx4 fake(px4_options(instance), [&](const FakePx4State& state) {
    Shares shares{};
    if (!state.truth) return shares;
    if (!start_mm) start_mm = state.truth->alt;
    const auto [roll, pitch, yaw] = angles_of(state);
    const double climb = 0.10 * (3.0 - 1e-3 * (state.truth->alt - *start_mm));
    const double thrust = 0.55 + climb + 0.10 * 1e-2 * state.truth->vz;
    const double r = -0.20 * roll - 0.05 * state.sensors.xgyro;
    const double p = -0.20 * pitch - 0.05 * state.sensors.ygyro;
    const double y = -0.10 * state.sensors.zgyro;
    shares[0] = static_cast<float>(thrust - r + p - y);
    shares[1] = static_cast<float>(thrust + r - p - y);
    shares[2] = static_cast<float>(thrust + r + p + y);
    shares[3] = static_cast<float>(thrust - r - p + y);
    return shares;
  });
  const std::string text = copter_text(px4(instance, "", 250));
  Session session = open(text);
  session.advance(Time{0});
  const double start_m = session.signal<Odometry>("drone/truth").value().X_WB.p.z();
  session.advance(Time{20 * kSecond});
  const Odometry& end = session.signal<Odometry>("drone/truth").value();
  EXPECT_NEAR(end.X_WB.p.z() - start_m, 3.0, 1.0);
  EXPECT_GT((end.X_WB.q * Eigen::Vector3d::UnitZ()).z(), 0.99);
  EXPECT_LT(std::abs(end.w_WB_B.z()), 0.1);
  EXPECT_THAT(session.crashes(), IsEmpty());
}

/// A firmware with MAVLink, as PX4 has it: bytewise parameters, missions without home, places on
/// its own sphere. It says that the mission is done when it has it.
TEST(Px4, GetsParametersAndAMissionByMavlink) {
  const int instance = free_px4_instance();
  mavlink::UdpSocket socket({kLoopback, 0}, "");
  const mavlink::UdpAddress station{kLoopback, static_cast<std::uint16_t>(14540 + instance)};
  controllers::autopilot_fake::FakeVehicle vehicle;
  vehicle.autopilot = mavlink::kAutopilotPx4;
  vehicle.ready_at_s = 2.0;
  vehicle.parameters = {{"NAV_ACC_RAD", 2.0F}};
  vehicle.whole_parameters = {{"COM_RC_IN_MODE", 1}};
  int steps = 0;
  FakePx4 fake(px4_options(instance), [&](const FakePx4State& state) {
    while (const auto datagram = socket.receive(std::chrono::milliseconds(0))) {
      vehicle.take(datagram->bytes);
    }
    vehicle.origin.latitude = 450'000'000;
    vehicle.origin.longitude = 90'000'000;
    vehicle.origin.altitude = 150'000;
    if (state.truth) {
      // PX4's projection near its origin: a sphere of 6371 km.
      constexpr double kUnit_m = 6'371'000.0 * 1e-7 * kPi / 180.0;
      vehicle.position.x = static_cast<float>(kUnit_m * (state.truth->lat - 450'000'000));
      vehicle.position.y = static_cast<float>(kUnit_m * std::cos(rad_from_deg(45.0)) *
                                              (state.truth->lon - 90'000'000));
      vehicle.position.z = static_cast<float>(150.0 - 1e-3 * state.truth->alt);
      vehicle.attitude.yaw = static_cast<float>(angles_of(state)[2]);
    }
    if (steps++ % 10 == 0) vehicle.step(1e-6 * static_cast<double>(state.sensors.time_usec));
    if (vehicle.has_started) {
      mavlink::MissionItemReached reached;
      reached.seq = static_cast<std::uint16_t>(vehicle.items.size() - 1);
      vehicle.send(reached);
    }
    for (const auto& frame : vehicle.to_station) socket.send(frame, station);
    vehicle.to_station.clear();
    return Shares{};
  });
  std::string text = px4_rover_text(
      px4(instance,
          ", parameters: [{name: COM_RC_IN_MODE, value: 4}, {name: NAV_ACC_RAD, value: 0.5}]"));
  replace(text, "turn_deg: 150", "turn_deg: 0");
  Session session = open(text + "    planner: {type: coverage}\n");
  session.advance(Time{20 * kSecond});
  EXPECT_TRUE(session.finished());
  EXPECT_EQ(vehicle.whole_parameters.at("COM_RC_IN_MODE"), 4);
  EXPECT_EQ(vehicle.parameters.at("NAV_ACC_RAD"), 0.5F);
  // Without home: the end of the alley is the only place.
  ASSERT_EQ(vehicle.items.size(), 1u);
  EXPECT_NEAR(vehicle.items[0].x, 450'000'000, 4000);
  EXPECT_EQ(vehicle.items[0].command, 16);
  EXPECT_EQ(vehicle.mode, 4u << 24 | 4u << 16);
  const Odometry& truth = session.signal<Odometry>("rover/truth").value();
  const Odometry& estimate = session.signal<Odometry>("rover/estimate").value();
  EXPECT_LT((truth.X_WB.p - estimate.X_WB.p).norm(), 0.1);
}

TEST(Px4, OutputsThatAreNoNumbersEndTheRun) {
  const int instance = free_px4_instance();
  FakePx4 fake(px4_options(instance), [](const FakePx4State& state) {
    return skid(0.3, state.truth ? std::nan("") : 0.3);
  });
  EXPECT_THAT(fault_of(px4_rover_text(px4(instance))),
              HasSubstr("rover.autopilot (px4): the autopilot sent nan as output 2"));
}

TEST(Px4, WaitsForItsSensorsAndSaysForWhich) {
  const int instance = free_px4_instance();
  FakePx4 fake(px4_options(instance), [](const FakePx4State&) { return skid(0.3, 0.3); });
  std::string text = px4_rover_text(px4(instance));
  replace(text, "type: magnetometer,", "type: magnetometer, outages: [{begin_s: 0, end_s: 12}],");
  Session session = open(text);
  session.advance(Time{11 * kSecond});
  EXPECT_EQ(session.signal<Event>("rover/autopilot_event").value().text,
            "the autopilot waits for the first reading of 'compass'");
  session.advance(Time{14 * kSecond});
  EXPECT_EQ(session.signal<Event>("rover/autopilot_event").value().text,
            "the autopilot has sent its first outputs");
  EXPECT_GT(session.signal<Odometry>("rover/truth").value().v_WB_B.x(), 0.2);
}

TEST(Px4, GetsThePilotsSticks) {
  const int instance = free_px4_instance();
  FakePx4 fake(px4_options(instance), [](const FakePx4State&) { return Shares{}; });
  Session session = open(px4_rover_text(px4(instance,
                                            ", sticks: [{at_s: 1, channel: 3, pulse_us: 1700}, "
                                            "{at_s: 1.5, channel: 1, pulse_us: 1100}]")));
  session.advance(Time{2 * kSecond});
  const auto states = fake.states_of_run();
  EXPECT_FALSE(states[90].sticks);
  ASSERT_TRUE(states[120].sticks);
  EXPECT_EQ(states[120].sticks->chan3_raw, 1700);
  EXPECT_EQ(states[120].sticks->chan1_raw, 65535);
  EXPECT_EQ(states[190].sticks->chan1_raw, 1100);
}

TEST(Px4, SaysWhatWentWrong) {
  const int instance = free_px4_instance();
  const std::string port = std::to_string(4560 + instance);
  EXPECT_THAT(fault_of(px4_rover_text(px4(instance, ", start_timeout_s: 0.2"))),
              HasSubstr("the autopilot did not connect to TCP port " + port + " for 0.2 s"));
  EXPECT_THAT(fault_of(px4_rover_text(px4(instance, ", command: [no_such_px4]"))),
              HasSubstr("'no_such_px4' cannot be started: No such file or directory"));
  EXPECT_THAT(
      fault_of(px4_rover_text(px4(instance, ", command: [sh, -c, 'echo no rootfs; exit 7']"))),
      HasSubstr("the autopilot ended with status 7; its last words: no rootfs"));
  EXPECT_THAT(fault_of(px4_rover_text(px4(instance, "", 1000))),
              HasSubstr("it is called at 1000 Hz; PX4 takes its sensors at 100 to 400 Hz: set "
                        "rate_Hz, for example to 250"));
  std::string blind = px4_rover_text(px4(instance));
  replace(blind, ", barometer: barometer", "");
  EXPECT_THAT(fault_of(blind), HasSubstr("barometer is missing: PX4 makes up no readings, so name "
                                         "the vehicle's sensor for it"));
  const auto with = [&](FakePx4Options manners) {
    manners.port = px4_options(instance).port;
    FakePx4 fake(manners, [](const FakePx4State&) { return Shares{}; });
    std::string text = px4_rover_text(px4(instance, ", start_timeout_s: 0.5"));
    replace(text, "answer_timeout_s: 5", "answer_timeout_s: 0.3");
    return fault_of(text);
  };
  FakePx4Options manners;
  manners.silent = 1'000'000;
  EXPECT_THAT(with(manners), HasSubstr("the autopilot sent no outputs for 0.5 s"));
  manners = {};
  manners.answers = 50;
  EXPECT_THAT(with(manners), HasSubstr("the autopilot sent nothing for 0.3 s (at 0."));
  manners.closes = true;
  EXPECT_THAT(with(manners), HasSubstr("the autopilot closed its connection"));
  manners = {};
  manners.wrong_stamp_at = 50;
  EXPECT_THAT(with(manners), HasSubstr("the autopilot answered the state of its clock's 0."));
  mavlink::TcpServer taken({kLoopback, px4_options(instance).port}, "");
  EXPECT_THAT(fault_of(px4_rover_text(px4(instance))),
              HasSubstr("cannot listen on TCP port " + port + ": another program has it"));
}

}  // namespace
}  // namespace vinerow::px4_test
