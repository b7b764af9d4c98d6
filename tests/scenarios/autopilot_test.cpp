// Vehicles under an autopilot: a small program that speaks ArduPilot's packets drives and flies
// them, so each sign is proved by motion.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/motion.h"
#include "engine/api/messages/sensors.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/mavlink/udp_socket.h"
#include "engine/run/run.h"
#include "tests/controllers/autopilot/fake_ardupilot.h"
#include "tests/controllers/autopilot/fake_vehicle.h"
#include "tests/scenarios/autopilot_support.h"
#include "tests/scenarios/session_support.h"
#include "tools/parts/register_all.h"
#include "vinerow/session.h"

namespace vinerow::autopilot_test {
namespace {

using controllers::FakeArdupilot;
using controllers::FakeOptions;
using controllers::FakeState;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Pulses = std::vector<std::uint16_t>;

std::uint16_t port_of(int instance) {
  return static_cast<std::uint16_t>(9002 + 10 * instance);
}

int free_instance() {
  return free_instance_of([](int instance) {
    mavlink::UdpSocket({kLoopback, port_of(instance)}, "");
  });
}

std::uint16_t pulse(double share) {
  return static_cast<std::uint16_t>(1500 + std::lround(500.0 * std::clamp(share, -1.0, 1.0)));
}
std::uint16_t motor_pulse(double share) {
  return static_cast<std::uint16_t>(1000 + std::lround(1000.0 * std::clamp(share, 0.0, 1.0)));
}

/// Roll, pitch, yaw of FRD in NED, rad.
std::array<double, 3> angles_of(const FakeState& state) {
  const auto [w, x, y, z] = state.quaternion;
  return {std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)), std::asin(2 * (w * y - z * x)),
          std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))};
}

/// Speed and clockwise turn towards a place, as shares.
std::pair<double, double> towards(const FakeState& state, double north_m, double east_m) {
  const double n = north_m - state.position[0], e = east_m - state.position[1];
  const double error = wrap_angle(std::atan2(e, n) - angles_of(state)[2]);
  const double distance_m = std::hypot(n, e);
  if (distance_m < 0.2) return {0.0, 0.0};
  return {std::min(0.3, 0.3 * distance_m) * std::max(0.0, std::cos(error)), 0.4 * error};
}

std::string ardupilot(int instance, const std::string& more = "") {
  return "type: ardupilot, rate_Hz: 100, answer_timeout_s: 5, instance: " +
         std::to_string(instance) + more;
}

FakeOptions fake_options(int instance, double think_s = 0.0) {
  FakeOptions options;
  options.port = port_of(instance);
  options.packets = 1'000'000;
  options.think_s = think_s;
  return options;
}

/// Drives 8 m in a direction relative to where it looks at first, positive to the right. Its first
/// state is its home: it knows nothing else about the world.
struct Driver {
  explicit Driver(double right_rad) : turn_rad(right_rad) {}
  std::pair<double, double> operator()(const FakeState& state) {
    if (!has_goal) {
      has_goal = true;
      const double course = angles_of(state)[2] + turn_rad;
      north_m = state.position[0] + 8.0 * std::cos(course);
      east_m = state.position[1] + 8.0 * std::sin(course);
    }
    return towards(state, north_m, east_m);
  }
  double turn_rad;
  bool has_goal = false;
  double north_m = 0.0, east_m = 0.0;
};

/// Distance of the vehicle from a driver's goal at the end of a run.
double miss_m(Session& session, const Driver& driver) {
  const Eigen::Vector3d p_W = session.signal<Odometry>("rover/truth").value().X_WB.p;
  return std::hypot(p_W.y() - driver.north_m, p_W.x() - driver.east_m);
}

TEST(Ardupilot, DrivesASkidRoverToAPlaceBehindIt) {
  const int instance = free_instance();
  Driver driver(rad_from_deg(150.0));
  FakeArdupilot fake(fake_options(instance), [&](const FakeState& state) {
    const auto [speed, turn] = driver(state);
    return Pulses{pulse(speed + turn), 1500, pulse(speed - turn)};
  });
  Session session = open(rover_text(ardupilot(instance)));
  session.advance(Time{40 * kSecond});
  EXPECT_LT(miss_m(session, driver), 0.3);
  EXPECT_THAT(fake.complaints(), ::testing::IsEmpty());
}

TEST(Ardupilot, GetsTheStateInItsFrames) {
  const int instance = free_instance();
  FakeArdupilot fake(fake_options(instance), [](const FakeState& state) {
    // Half ahead, and after two seconds a turn to the right.
    const double turn = state.timestamp_s > 2.0 ? 0.2 : 0.0;
    return Pulses{pulse(0.3 + turn), 1500, pulse(0.3 - turn)};
  });
  Session session = open(rover_text(ardupilot(instance)));
  const auto truth = session.signal<Odometry>("rover/truth");
  session.advance(Time{0});
  const Odometry start = truth.value();
  session.advance(Time{3 * kSecond});
  const std::vector<FakeState> states = fake.states();
  ASSERT_GE(states.size(), 300u);

  const FakeState& first = states.front();
  EXPECT_NEAR(first.timestamp_s, 0.01, 1e-6);
  EXPECT_NEAR(first.position[0], start.X_WB.p.y(), 1e-9);
  EXPECT_NEAR(first.position[1], start.X_WB.p.x(), 1e-9);
  EXPECT_NEAR(first.position[2], -start.X_WB.p.z(), 1e-9);
  // North is the direction y of W: a heading of 90 deg from east is a yaw of 0.
  const double heading =
      std::atan2(start.X_WB.q.toRotationMatrix()(1, 0), start.X_WB.q.toRotationMatrix()(0, 0));
  EXPECT_NEAR(wrap_angle(angles_of(first)[2] - (0.5 * kPi - heading)), 0.0, 1e-8);
  // At rest on level ground the accelerometer shows 1 g upwards, which is negative in FRD.
  EXPECT_NEAR(states[50].accel_body[2], -9.80665, 0.5);

  // Driving: the velocity points where the body points, and the turn to the right is positive.
  const FakeState& ahead = states[180];
  const double yaw = angles_of(ahead)[2];
  const double speed = std::hypot(ahead.velocity[0], ahead.velocity[1]);
  EXPECT_GT(speed, 0.2);
  EXPECT_NEAR(ahead.velocity[0], speed * std::cos(yaw), 0.05);
  EXPECT_NEAR(ahead.velocity[1], speed * std::sin(yaw), 0.05);
  const FakeState& right = states[290];
  EXPECT_GT(right.gyro[2], 0.05);
  EXPECT_GT(wrap_angle(angles_of(right)[2] - yaw), 0.02);
}

TEST(Ardupilot, ClockOfTheAutopilotLosesNothing) {
  const int instance = free_instance();
  FakeArdupilot fake(fake_options(instance), [](const FakeState&) { return Pulses{}; });
  Session session = open(rover_text(ardupilot(instance)));
  session.advance(Time{20 * kSecond});
  // Its own rule: whole microseconds of each step.
  std::int64_t clock_us = 0;
  double last_s = 0.0;
  for (const FakeState& state : fake.states()) {
    clock_us += static_cast<std::int64_t>((state.timestamp_s - last_s) * 1e6);
    last_s = state.timestamp_s;
  }
  EXPECT_EQ(clock_us, 10'000 * static_cast<std::int64_t>(fake.states().size()));
}

TEST(Ardupilot, SteersBothAxlesOfARover) {
  const int instance = free_instance();
  Driver driver(rad_from_deg(-60.0));
  FakeArdupilot fake(fake_options(instance), [&](const FakeState& state) {
    const auto [speed, turn] = driver(state);
    // SERVO1 front, SERVO2 rear reversed, SERVO3 throttle.
    return Pulses{pulse(2.0 * turn), pulse(-2.0 * turn), pulse(std::min(speed, 0.25) + 0.1)};
  });
  std::string text = rover_text(ardupilot(instance));
  replace(text, "diff_drive_rover", "four_wheel_steering_rover");
  replace(text, "turn_deg: 150", "turn_deg: -60");
  Session session = open(text);
  // It cannot stop at the goal with a throttle that never ends: it passes near it.
  double nearest_m = 100.0;
  for (int k = 1; k <= 300; ++k) {
    session.advance(Time{k * kSecond / 10});
    nearest_m = std::min(nearest_m, miss_m(session, driver));
  }
  EXPECT_LT(nearest_m, 0.6);
}

TEST(Ardupilot, HoldsAQuadrotorAtAHeight) {
  const int instance = free_instance();
  double start_down_m = 0.0;
  bool has_started = false;
  // Attitude by a PD law, mixed for a reversed X: 1 rear right, 2 front right, 3 rear left,
  // 4 front left. A roll to the right needs thrust on the left, a pitch up thrust in front; a rotor
  // that turns counter-clockwise (front left and rear right) turns the body clockwise.
  FakeArdupilot fake(fake_options(instance), [&](const FakeState& state) {
    if (!has_started) start_down_m = state.position[2];
    has_started = true;
    const auto [roll, pitch, yaw] = angles_of(state);
    const double climb = 0.10 * (start_down_m - 3.0 - state.position[2]);
    const double thrust = 0.55 - climb + 0.10 * state.velocity[2];
    const double r = -0.20 * roll - 0.05 * state.gyro[0];
    const double p = -0.20 * pitch - 0.05 * state.gyro[1];
    const double y = -0.10 * state.gyro[2];
    return Pulses{motor_pulse(thrust - r - p + y), motor_pulse(thrust - r + p - y),
                  motor_pulse(thrust + r - p - y), motor_pulse(thrust + r + p + y)};
  });
  const std::string text = R"(
vinerow: 1
name: hover
duration_s: 20
world: {type: vineyard, row_count: 2, row_length_m: 20, relief_m: 0, waves_m: 0, leaf_cards_per_m: 10, plant_variants: 1}
vehicles:
  drone:
    type: quadrotor
    spawn: {alley: 0, offset_m: 4}
    autopilot: {type: ardupilot, rate_Hz: 500, instance: )" +
                           std::to_string(instance) + "}\n";
  Session session = open(text);
  session.advance(Time{0});
  const double start_m = session.signal<Odometry>("drone/truth").value().X_WB.p.z();
  session.advance(Time{20 * kSecond});
  const Odometry& end = session.signal<Odometry>("drone/truth").value();
  EXPECT_NEAR(end.X_WB.p.z() - start_m, 3.0, 1.0);
  EXPECT_GT((end.X_WB.q * Eigen::Vector3d::UnitZ()).z(), 0.99);
  EXPECT_LT(std::abs(end.w_WB_B.z()), 0.1);
  EXPECT_THAT(session.crashes(), ::testing::IsEmpty());
}

TEST(Ardupilot, SameDigestAtAnyPaceAndInReplay) {
  const test::ScratchFolder folder("autopilot_replay");
  const auto drive = [&](double think_s) {
    const int instance = free_instance();
    Driver driver(rad_from_deg(150.0));
    FakeArdupilot fake(fake_options(instance, think_s), [&](const FakeState& state) {
      const auto [speed, turn] = driver(state);
      return Pulses{pulse(speed + turn), 1500, pulse(speed - turn)};
    });
    Session session =
        open(rover_text(ardupilot(instance, ", record: drive.pcap")), folder.path() / "products");
    session.advance(Time{3 * kSecond});
    return session.digest();
  };
  const std::string fast = drive(0.0), slow = drive(0.001);
  EXPECT_EQ(fast, slow);
  const std::string file = (folder.path() / "products" / "rover.autopilot" / "drive.pcap").string();
  const std::string replay = "type: replay, rate_Hz: 100, file: " + file;
  Session session = open(rover_text(replay));
  session.advance(Time{3 * kSecond});
  EXPECT_EQ(session.digest(), fast);
  // The recording is as long as the flight, and of this flight alone.
  const auto fault = [](Session& run) {
    try {
      run.advance(Time{4 * kSecond});
    } catch (const SimulationError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(fault(session), HasSubstr("the autopilot is a recording, which ends here"));
  std::string other = rover_text(replay);
  replace(other, "turn_deg: 150", "turn_deg: 149");
  Session elsewhere = open(other);
  EXPECT_THAT(fault(elsewhere), HasSubstr("of another flight: the state was"));
}

TEST(Ardupilot, GetsReadingsInsteadOfTheTruthWhereTheyAreNamed) {
  const int instance = free_instance();
  FakeArdupilot fake(fake_options(instance), [](const FakeState&) { return Pulses{}; });
  std::string text = rover_text(
      ardupilot(instance,
                ", imu: imu, ranges: [sonar], battery_V: 24, sticks: [{at_s: 1, channel: 3, "
                "pulse_us: 1700}]"));
  replace(text, "sensors: {",
          "sensors: {imu: {type: imu, rate_Hz: 100}, sonar: {type: ultrasound, rate_Hz: 20, "
          "position_m: [0.4, 0, 0.3]}, ");
  Session session = open(text);
  session.advance(Time{2 * kSecond});
  const auto states = fake.states();
  ASSERT_GE(states.size(), 200u);
  const auto imu = session.signal<ImuSample>("rover/imu");
  EXPECT_NEAR(states.back().gyro[2], -imu.value().w_WS_S.z(), 1e-9);
  EXPECT_NEAR(states.back().accel_body[2], -imu.value().f_WS_S.z(), 1e-9);
  ASSERT_TRUE(states.back().ranges_m[0]);
  const auto sonar = session.signal<RangeSample>("rover/sonar");
  EXPECT_NEAR(*states.back().ranges_m[0],
              std::min(sonar.value().range_m, sonar.value().max_range_m + 1.0), 1e-9);
  EXPECT_EQ(states.back().battery_V, 24.0);
  EXPECT_EQ(states[50].sticks_us[2], std::nullopt);
  EXPECT_EQ(states[150].sticks_us[2], 1700.0);
}

/// A firmware with MAVLink: it drives from item to item of the mission that it gets, in the frame
/// of ArduPilot's own receiver.
class MissionFirmware {
 public:
  explicit MissionFirmware(int instance)
      : socket_({kLoopback, 0}, ""),
        peer_{kLoopback, static_cast<std::uint16_t>(14555 + 10 * instance)},
        fake_(fake_options(instance), [this](const FakeState& state) { return step(state); }) {
    vehicle.ready_at_s = 2.0;
  }
  const FakeArdupilot& fake() const { return fake_; }
  controllers::autopilot_fake::FakeVehicle vehicle;
  std::size_t next_item = 1;  ///< 0 is home

 private:
  Pulses step(const FakeState& state) {
    while (const auto datagram = socket_.receive(std::chrono::milliseconds(0))) {
      vehicle.take(datagram->bytes);
    }
    // The local coordinates begin where the vehicle stands at first.
    if (steps_ == 0) home_ = state.position;
    constexpr double kUnit_m = 0.011131884502145034;
    const double east_m = kUnit_m * std::cos(rad_from_deg(1e-7 * home_latitude));
    vehicle.origin.latitude = home_latitude + static_cast<int>(std::lround(home_[0] / kUnit_m));
    vehicle.origin.longitude = home_longitude + static_cast<int>(std::lround(home_[1] / east_m));
    vehicle.position.x = static_cast<float>(state.position[0] - home_[0]);
    vehicle.position.y = static_cast<float>(state.position[1] - home_[1]);
    vehicle.position.z = static_cast<float>(state.position[2] - home_[2]);
    vehicle.origin.altitude = static_cast<int>(std::lround(1000.0 * (150.0 - home_[2])));
    const auto [roll, pitch, yaw] = angles_of(state);
    vehicle.attitude.roll = static_cast<float>(roll);
    vehicle.attitude.pitch = static_cast<float>(pitch);
    vehicle.attitude.yaw = static_cast<float>(yaw);
    if (steps_++ % 10 == 0) vehicle.step(state.timestamp_s);
    std::pair<double, double> drive{0.0, 0.0};
    if (vehicle.has_started && next_item < vehicle.items.size()) {
      const mavlink::MissionItemInt& item = vehicle.items[next_item];
      const double north_m = kUnit_m * (item.x - home_latitude);
      const double to_east_m = east_m * (item.y - home_longitude);
      drive = towards(state, north_m, to_east_m);
      if (item.command != 16 ||
          std::hypot(north_m - state.position[0], to_east_m - state.position[1]) < 0.25) {
        mavlink::MissionItemReached reached;
        reached.seq = static_cast<std::uint16_t>(next_item++);
        vehicle.send(reached);
      }
    }
    for (const auto& frame : vehicle.to_station) socket_.send(frame, peer_);
    vehicle.to_station.clear();
    const auto [speed, turn] = drive;
    return {pulse(speed + turn), 1500, pulse(speed - turn)};
  }

  static constexpr int home_latitude = 450'000'000, home_longitude = 90'000'000;
  mavlink::UdpSocket socket_;
  mavlink::UdpAddress peer_;
  std::array<double, 3> home_{};
  int steps_ = 0;
  FakeArdupilot fake_;  // last: its thread uses the others
};

/// An alley to be driven by a plan of ours, and a rover that begins near it.
std::string mission_text(const std::string& autopilot) {
  std::string text = rover_text(autopilot);
  replace(text, "world: {type: vineyard,",
          "world: {type: vineyard, origin_latitude_deg: 45, origin_longitude_deg: 9, "
          "origin_altitude_m: 150, ");
  replace(text, "turn_deg: 150", "turn_deg: 0");
  replace(text, "duration_s: 40", "duration_s: 120");
  return text + "    planner: {type: coverage}\n";
}

TEST(Ardupilot, DrivesAPlanOfOursAsItsMission) {
  const test::ScratchFolder folder("autopilot_mission");
  const int instance = free_instance();
  MissionFirmware firmware(instance);
  // The recording is whole when its session has ended.
  std::optional<Session> recorded =
      open(mission_text(ardupilot(instance, ", record: mission.pcap")), folder.path() / "products");
  Session& session = *recorded;
  session.advance(Time{120 * kSecond});
  EXPECT_TRUE(session.finished());
  EXPECT_GE(firmware.vehicle.items.size(), 2u);
  EXPECT_EQ(firmware.next_item, firmware.vehicle.items.size());
  EXPECT_THAT(firmware.fake().complaints(), ::testing::IsEmpty());
  // What the firmware believes is where the vehicle is: 1e-7 degrees are 1.1 cm.
  const Odometry& truth = session.signal<Odometry>("rover/truth").value();
  const Odometry& estimate = session.signal<Odometry>("rover/estimate").value();
  EXPECT_LT((truth.X_WB.p - estimate.X_WB.p).norm(), 0.1);
  EXPECT_NEAR(std::abs(truth.X_WB.q.dot(estimate.X_WB.q)), 1.0, 1e-3);

  // The recording gives the same run, with its estimate and the end of its mission.
  const std::string digest = session.digest();
  recorded.reset();
  const auto file = folder.path() / "products" / "rover.autopilot" / "mission.pcap";
  Session again = open(mission_text("type: replay, rate_Hz: 100, file: " + file.string()));
  again.advance(Time{120 * kSecond});
  EXPECT_TRUE(again.finished());
  EXPECT_EQ(again.digest(), digest);
}

TEST(Ardupilot, SaysWhyAMissionIsNotFlown) {
  const int instance = free_instance();
  MissionFirmware firmware(instance);
  firmware.vehicle.mission_result = mavlink::kMissionNoSpace;
  Session session = open(mission_text(ardupilot(instance)));
  session.advance(Time{20 * kSecond});
  ASSERT_EQ(session.crashes().size(), 1u);
  EXPECT_EQ(session.crashes()[0].text, "the autopilot refused the mission: it has no room for it");
}

TEST(Ardupilot, GetsTheReadingsOfOurReceiver) {
  const int instance = free_instance();
  MissionFirmware firmware(instance);
  std::string text = rover_text(ardupilot(instance, ", gnss: gps"));
  Session session = open(text);
  session.advance(Time{5 * kSecond});
  // Ten each second, but for those before its first message.
  ASSERT_GE(firmware.vehicle.fixes.size(), 45u);
  const auto gps = session.signal<GnssFix>("rover/gps");
  EXPECT_NEAR(firmware.vehicle.fixes.back().lat, 1e7 * deg_from_rad(gps.value().latitude_rad), 1.0);
  EXPECT_EQ(firmware.vehicle.fixes.back().fix_type, 3);
}

TEST(Ardupilot, SaysWhatWentWrong) {
  const int instance = free_instance();
  const std::string number = std::to_string(instance);
  EXPECT_THAT(fault_of(rover_text("type: ardupilot, start_timeout_s: 0.2, instance: " + number)),
              HasSubstr("the autopilot sent nothing to UDP port " +
                        std::to_string(port_of(instance)) + " for 0.2 s"));
  EXPECT_THAT(
      fault_of(rover_text("type: ardupilot, command: [no_such_autopilot], instance: " + number)),
      HasSubstr("'no_such_autopilot' cannot be started: No such file or directory"));
  EXPECT_THAT(
      fault_of(rover_text(
          "type: ardupilot, command: [sh, -c, 'echo no frame; exit 7'], instance: " + number)),
      HasSubstr("the autopilot ended with status 7; its last words: no frame"));
  EXPECT_THAT(fault_of(rover_text("type: ardupilot, address: localhost, instance: " + number)),
              HasSubstr("address = 'localhost', must be an IPv4 address such as 127.0.0.1"));
  EXPECT_THAT(fault_of(rover_text("type: ardupilot, record: ../x.pcap, instance: " + number)),
              HasSubstr("record = '../x.pcap', must be a name without folders"));
  EXPECT_THAT(fault_of(rover_text("type: ardupilot, channels: [{function: left, output: 1}]")),
              HasSubstr("channels: no output drives 'right'; needed are left, right"));
  EXPECT_THAT(fault_of(rover_text("type: ardupilot") + "    controller: {type: remote_velocity}\n"),
              HasSubstr("rover.controller: the vehicle has an autopilot ('ardupilot'), which takes "
                        "the place of estimator, guidance and controller"));
  mavlink::UdpSocket taken({kLoopback, port_of(instance)}, "");
  EXPECT_THAT(fault_of(rover_text(ardupilot(instance))),
              HasSubstr("cannot listen on UDP port " + std::to_string(port_of(instance)) +
                        ": another program has it"));
}

TEST(Ardupilot, TwoWithOnePortAreRefusedBeforeTheRun) {
  const int instance = free_instance();
  const auto text = [&](int of_other, const std::string& more) {
    return rover_text(ardupilot(instance)) +
           "  other:\n    type: diff_drive_rover\n    spawn: {alley: 0}\n    autopilot: {" +
           ardupilot(of_other, more) + "}\n";
  };
  EXPECT_THAT(
      fault_of(text(instance, ""), 0),
      HasSubstr("other.autopilot (ardupilot): UDP port " + std::to_string(port_of(instance)) +
                " of 127.0.0.1 is that of rover.autopilot (ardupilot): give one of them "
                "another instance or mavlink_port"));
  const std::string mavlink_port = std::to_string(14555 + 10 * instance);
  EXPECT_THAT(fault_of(text(instance + 1, ", mavlink_port: " + mavlink_port), 0),
              HasSubstr("UDP port " + mavlink_port + " of 127.0.0.1 is that of rover.autopilot"));
  // Other instances are built, twice: nothing has been started.
  Session session = open(text(instance + 1, ""));
  session.reset(2);
  EXPECT_EQ(session.now().ns, 0);
}

/// Parts beside a firmware, which no check before a run starts.
TEST(Ardupilot, RehearsalChecksWhatIsBesideIt) {
  Registry registry;
  register_all(registry);
  const auto rehearse = [&](const std::string& text) -> std::string {
    try {
      const auto notes =
          run::rehearse_run(scenario::parse_scenario(text, ".", registry, {}), registry);
      EXPECT_THAT(notes, ::testing::Contains(HasSubstr("no firmware is started")));
      return "";
    } catch (const ConfigError& error) {
      return error.what();
    }
  };
  const std::string text = rover_text(ardupilot(free_instance()));
  EXPECT_EQ(rehearse(text), "");
  std::string buried = text;
  replace(buried, "sensors: {", "sensors: {front: {type: camera, position_m: [0, 0, -1]}, ");
  EXPECT_THAT(rehearse(buried), HasSubstr("rover.sensors.front: the camera is below the ground"));
  // Without a fix in the first instant, so that its plan comes later.
  EXPECT_THAT(rehearse(text + R"(
  other:
    type: diff_drive_rover
    spawn: {alley: 0}
    sensors: {gps: {type: gps, rate_Hz: 5}, imu: {type: imu, rate_Hz: 100}}
    estimator: {type: gps_pose}
    planner: {type: waypoints, x_m: [900], y_m: [900]}
    controller: {type: pure_pursuit}
)"),
              HasSubstr("other.planner (waypoints)"));
}

std::vector<std::string> autopilots() {
  Registry registry;
  register_all(registry);
  return registry.names(PartKind::kAutopilot);
}

/// What the kernel may expect of any autopilot. A new one needs a line in make_firmware().
class AutopilotConformance : public ::testing::TestWithParam<std::string> {
 protected:
  AutopilotConformance() : folder_("autopilot_conformance") {}

  /// Something that answers `packets` states. @returns the vehicle's autopilot
  std::string make_firmware(int packets) {
    if (GetParam() == "ardupilot") return ardupilot(start_fake(packets));
    if (GetParam() == "px4") return px4(start_fake_px4(packets));
    if (GetParam() == "replay") {
      const std::string record = ", record: drive.pcap";
      const auto out = folder_.path() / ("products" + std::to_string(packets));
      Session session = open(px4_rover_text(ardupilot(start_fake(1'000'000), record)), out);
      session.advance(Time{(packets - 1) * 10'000'000LL});
      const auto file = out / "rover.autopilot" / "drive.pcap";
      return "type: replay, rate_Hz: 100, file: " + file.string();
    }
    ADD_FAILURE() << "no firmware for " << GetParam();
    return "";
  }

 private:
  int start_fake(int packets) {
    const int instance = free_instance();
    FakeOptions options = fake_options(instance);
    options.packets = packets;
    fake_ = std::make_unique<FakeArdupilot>(options, [](const FakeState&) {
      return Pulses{pulse(0.3), 1500, pulse(0.25)};
    });
    return instance;
  }

  int start_fake_px4(int packets) {
    const int instance = free_px4_instance();
    controllers::FakePx4Options options = px4_options(instance);
    // The last answer while it boots counts too.
    options.answers = packets;
    fake_px4_ =
        std::make_unique<controllers::FakePx4>(options, [](const controllers::FakePx4State&) {
          return controllers::FakePx4::Shares{0.3F, 0.25F};
        });
    return instance;
  }

  test::ScratchFolder folder_;
  std::unique_ptr<FakeArdupilot> fake_;
  std::unique_ptr<controllers::FakePx4> fake_px4_;
};

TEST_P(AutopilotConformance, WritesActuatorsOncePerPeriodAndRepeats) {
  std::vector<std::string> digests;
  for (int run = 0; run < 2; ++run) {
    Session session = open(px4_rover_text(make_firmware(1000)));
    session.advance(Time{2 * kSecond});
    const SignalBase& actuators = session.any_signal("rover/actuators");
    EXPECT_EQ(actuators.sequence(), 201u);  // at 100 Hz, with both ends
    EXPECT_EQ(actuators.stamp(), Time{2 * kSecond});
    EXPECT_EQ(actuators.writer(), "rover.autopilot");
    EXPECT_FALSE(session.finished());
    digests.push_back(session.digest());
  }
  EXPECT_EQ(digests[0], digests[1]);
}

TEST_P(AutopilotConformance, SilenceEndsTheRunWithItsName) {
  std::string text = make_firmware(51);
  if (const auto at = text.find("answer_timeout_s: 5"); at != std::string::npos) {
    text.replace(at, 19, "answer_timeout_s: 0.3");
  }
  Session session = open(px4_rover_text(text));
  try {
    session.advance(Time{2 * kSecond});
    ADD_FAILURE() << "it went on";
  } catch (const SimulationError& error) {
    EXPECT_THAT(error.what(), HasSubstr("rover.autopilot (" + GetParam() + "): the autopilot "));
    EXPECT_NEAR(session.now().s(), 0.5, 0.02);
  }
}

TEST_P(AutopilotConformance, HasNoEstimatorBesideIt) {
  EXPECT_THAT(fault_of(px4_rover_text(make_firmware(10)) + "    estimator: {type: truth}\n"),
              HasSubstr("rover.estimator: the vehicle has an autopilot ('" + GetParam() + "')"));
}

INSTANTIATE_TEST_SUITE_P(Types, AutopilotConformance, ::testing::ValuesIn(autopilots()));

TEST(Ardupilot, EndOfTheRunEndsWhatItHasStarted) {
  const int instance = free_instance();
  const test::ScratchFolder folder("autopilot_process");
  const auto file = folder.path() / "alive";
  // A program that lives as long as it may and writes while it lives.
  fault_of(
      rover_text("type: ardupilot, start_timeout_s: 0.5, command: [sh, -c, 'while true; do "
                 "date +%N > " +
                 file.string() + "; sleep 0.05; done'], instance: " + std::to_string(instance)));
  ASSERT_TRUE(std::filesystem::exists(file));
  const auto last = std::filesystem::last_write_time(file);
  ::usleep(300'000);
  EXPECT_EQ(std::filesystem::last_write_time(file), last);
}

}  // namespace
}  // namespace vinerow::autopilot_test
