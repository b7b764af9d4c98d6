// Packets, lines and the lock-step of ArduPilot's JSON interface, against a program that reads as
// ArduPilot does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "controllers/autopilot/ardupilot/lockstep_link.h"
#include "controllers/autopilot/ardupilot/state_line.h"
#include "engine/core/error.h"
#include "tests/controllers/autopilot/fake_ardupilot.h"

namespace vinerow::controllers::ardupilot_link_test {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::uint32_t kLoopback = 0x7F000001;

std::vector<std::uint8_t> packet_bytes(std::uint16_t magic, int channels) {
  std::vector<std::uint8_t> bytes = {static_cast<std::uint8_t>(magic & 0xFF),
                                     static_cast<std::uint8_t>(magic >> 8),
                                     0x90,
                                     0x01,
                                     7,
                                     0,
                                     1,
                                     0};
  for (int i = 0; i < channels; ++i) {
    const int pulse = 1000 + i;
    bytes.push_back(static_cast<std::uint8_t>(pulse & 0xFF));
    bytes.push_back(static_cast<std::uint8_t>(pulse >> 8));
  }
  return bytes;
}

TEST(ServoPacket, HasTheLayoutOfTheInterface) {
  for (const int channels : {16, 32}) {
    const auto packet = parse_servo_packet(packet_bytes(channels == 16 ? 18458 : 29569, channels));
    ASSERT_TRUE(packet) << packet.reason();
    EXPECT_EQ(packet->frame_rate_Hz, 400);
    EXPECT_EQ(packet->frame, 65543u);
    EXPECT_EQ(packet->channels, channels);
    EXPECT_EQ(packet->pwm_us[0], 1000);
    EXPECT_EQ(packet->pwm_us[channels - 1], 1000 + channels - 1);
  }
}

TEST(ServoPacket, SaysWhatIsWrongWithOthers) {
  EXPECT_EQ(parse_servo_packet({}).reason(),
            "sent 0 bytes, too few for a packet of servo outputs (40 or 72)");
  EXPECT_EQ(parse_servo_packet(packet_bytes(18459, 16)).reason(),
            "sent a packet that begins with 18459, not with 18458 or 29569 as servo outputs of "
            "ArduPilot do");
  EXPECT_EQ(parse_servo_packet(packet_bytes(18458, 15)).reason(),
            "sent 38 bytes, but servo outputs with 16 channels have 40");
  EXPECT_EQ(parse_servo_packet(packet_bytes(29569, 16)).reason(),
            "sent 40 bytes, but servo outputs with 32 channels have 72");
}

ArdupilotState full_state() {
  ArdupilotState state;
  state.timestamp_s = 12.345000012;
  state.gyro_FRD_radps = {0.1, -0.2, 0.3};
  state.specific_force_FRD_mps2 = {1e-12, 0.0, -9.80665};
  state.position_NED_m = {-1234.5678, 20.0, -3.0};
  state.velocity_NED_mps = {0.5, -0.25, 0.125};
  state.q_NED_FRD = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
  state.ranges_m = {1.5, std::nullopt, 2.5, std::nullopt, std::nullopt, 6.0};
  state.airspeed_mps = 17.25;
  state.battery_V = 12.5;
  state.battery_A = 3.5;
  state.sticks_us[0] = 1500;
  state.sticks_us[9] = 1900;
  return state;
}

TEST(StateLine, IsReadAsItIsMeant) {
  StateLine line;
  FakeState read;
  const std::string_view text = line.write(full_state());
  ASSERT_EQ(read_as_ardupilot(text, read), "");
  EXPECT_DOUBLE_EQ(read.timestamp_s, 12.345000012);
  EXPECT_THAT(read.gyro, ElementsAre(0.1, -0.2, 0.3));
  EXPECT_THAT(read.accel_body, ElementsAre(0.0, 0.0, -9.80665));
  EXPECT_THAT(read.position, ElementsAre(-1234.5678, 20.0, -3.0));
  EXPECT_THAT(read.velocity, ElementsAre(0.5, -0.25, 0.125));
  EXPECT_THAT(read.quaternion, ElementsAre(0.5, -0.5, 0.5, 0.5));
  EXPECT_EQ(read.ranges_m[0], 1.5);
  EXPECT_EQ(read.ranges_m[1], std::nullopt);
  EXPECT_EQ(read.ranges_m[5], 6.0);
  EXPECT_EQ(read.airspeed_mps, 17.25);
  EXPECT_EQ(read.battery_V, 12.5);
  EXPECT_EQ(read.battery_A, 3.5);
  EXPECT_EQ(read.sticks_us[0], 1500.0);
  EXPECT_EQ(read.sticks_us[9], 1900.0);
  EXPECT_EQ(read.sticks_us[1], std::nullopt);
}

TEST(StateLine, IsJson) {
  StateLine line;
  const auto json = nlohmann::json::parse(line.write(full_state()));
  EXPECT_EQ(json["imu"]["gyro"][1], -0.2);
  EXPECT_EQ(json["battery"]["current"], 3.5);
  EXPECT_EQ(json["rc"]["rc_10"], 1900.0);
  EXPECT_FALSE(nlohmann::json::parse(line.write({})).contains("battery"));
}

TEST(StateLine, IsEmptyForWhatWouldKillTheAutopilot) {
  StateLine line;
  ArdupilotState state;
  state.gyro_FRD_radps.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(line.write(state), "");
  state = {};
  state.ranges_m[3] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(line.write(state), "");
  EXPECT_NE(line.write({}), "");
}

TEST(StateLine, HasRoomForTheLargestNumbers) {
  StateLine line;
  ArdupilotState state = full_state();
  for (auto* vector : {&state.gyro_FRD_radps, &state.specific_force_FRD_mps2, &state.position_NED_m,
                       &state.velocity_NED_mps}) {
    vector->setConstant(-1e300);
  }
  for (auto& range : state.ranges_m) range = -1e300;
  for (auto& stick : state.sticks_us) stick = 65535;
  FakeState read;
  EXPECT_EQ(read_as_ardupilot(line.write(state), read), "");
}

/// Steps of 1 ms until the autopilot has had enough.
struct Bench {
  explicit Bench(FakeOptions options)
      : link({kLoopback, 0}, "rover.autopilot (ardupilot)"), steps(options.packets) {
    options.port = link.port();
    fake.emplace(options, [](const FakeState& state) {
      return std::vector<std::uint16_t>{
          static_cast<std::uint16_t>(1000 + std::lround(state.timestamp_s * 1000.0) % 1000)};
    });
  }
  std::string run(milliseconds limit = milliseconds(3000)) {
    const auto no = [] { return std::string(); };
    auto packet = link.wait_for_first(limit, no);
    StateLine line;
    for (int step = 0; packet && step < steps - 1; ++step) {
      ArdupilotState state;
      state.timestamp_s = 0.001 * step;
      link.answer(line.write(state));
      packet = link.wait_for_next(limit, no);
      // The pulses answer the state of this step, not of an earlier one.
      if (packet) {
        EXPECT_EQ(packet->pwm_us[0], 1000 + step % 1000) << step;
      }
      ++done;
    }
    return packet ? "" : packet.reason();
  }
  LockstepLink link;
  std::optional<FakeArdupilot> fake;
  int steps;
  int done = 0;
};

TEST(ArdupilotLockstep, AnswersEachPacketOnce) {
  for (const int channels : {16, 32}) {
    FakeOptions options;
    options.packets = 2000;
    options.channels = channels;
    Bench bench(options);
    EXPECT_EQ(bench.run(), "");
    EXPECT_EQ(bench.done, 1999);
    EXPECT_EQ(bench.fake->answers(), 1999);
    EXPECT_THAT(bench.fake->complaints(), IsEmpty());
  }
}

TEST(ArdupilotLockstep, IsNotMovedByRepetitionsDelaysAndLosses) {
  FakeOptions late, repeated, lost;
  late.packets = repeated.packets = lost.packets = 20;
  late.start_after_s = 0.3;
  late.think_s = 0.002;
  repeated.repeat_at = 7;
  lost.ignore_answer_at = 7;
  for (const FakeOptions& options : {late, repeated, lost}) {
    Bench bench(options);
    EXPECT_EQ(bench.run(), "");
    EXPECT_EQ(bench.fake->answers(), 19);
  }
}

TEST(ArdupilotLockstep, SaysWhyItGivesUp) {
  FakeOptions jump, restart, magic, cut, dies;
  jump.jump_at = 5;
  restart.restart_at = 5;
  magic.magic = 4660;
  cut.short_at = 5;
  dies.packets = 5;
  EXPECT_EQ(Bench(jump).run(), "sent packet 6 after packet 4");
  EXPECT_EQ(Bench(restart).run(), "has restarted after packet 4");
  EXPECT_THAT(Bench(magic).run(), HasSubstr("begins with 4660"));
  EXPECT_EQ(Bench(cut).run(), "sent 38 bytes, but servo outputs with 16 channels have 40");
  Bench dead(dies);
  dead.steps = 10;
  EXPECT_EQ(dead.run(milliseconds(200)), "sent nothing for 0.2 s (packet 4)");
  LockstepLink silent({kLoopback, 0}, "rover.autopilot (ardupilot)");
  EXPECT_THAT(silent.wait_for_first(milliseconds(200), [] { return std::string(); }).reason(),
              ::testing::MatchesRegex("sent nothing to UDP port [0-9]+ for 0.2 s"));
  EXPECT_EQ(silent.wait_for_first(milliseconds(5000), [] { return std::string("ended"); }).reason(),
            "ended");
}

TEST(ArdupilotLockstep, RefusesASecondAutopilot) {
  LockstepLink link({kLoopback, 0}, "rover.autopilot (ardupilot)");
  FakeOptions options;
  options.port = link.port();
  options.packets = 2;
  const auto still = [](const FakeState&) { return std::vector<std::uint16_t>{}; };
  const auto no = [] { return std::string(); };
  FakeArdupilot first(options, still);
  ASSERT_TRUE(link.wait_for_first(milliseconds(3000), no));
  FakeArdupilot second(options, still);
  std::this_thread::sleep_for(milliseconds(200));
  StateLine line;
  link.answer(line.write({}));
  const auto packet = link.wait_for_next(milliseconds(3000), no);
  ASSERT_FALSE(packet);
  EXPECT_THAT(packet.reason(), HasSubstr("is not alone: programs at the ports"));
}

TEST(UdpSocket, SaysThatItsPortIsTaken) {
  mavlink::UdpSocket first({kLoopback, 0}, "rover.autopilot (ardupilot)");
  try {
    mavlink::UdpSocket second({kLoopback, first.port()}, "rover.autopilot (ardupilot)");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(std::string(error.what()), "rover.autopilot (ardupilot): cannot listen on UDP port " +
                                             std::to_string(first.port()) +
                                             ": another program has it");
  }
}

TEST(UdpSocket, TellsThatADatagramWasCut) {
  mavlink::UdpSocket receiver({kLoopback, 0}, ""), sender({kLoopback, 0}, "");
  sender.send(std::vector<std::uint8_t>(3000, 1), {kLoopback, receiver.port()});
  const auto datagram = receiver.receive(milliseconds(1000));
  ASSERT_TRUE(datagram);
  EXPECT_TRUE(datagram->is_cut);
  EXPECT_EQ(datagram->bytes.size(), mavlink::UdpSocket::kMaxDatagram);
  EXPECT_EQ(datagram->from, (mavlink::UdpAddress{kLoopback, sender.port()}));
  EXPECT_EQ(receiver.receive(milliseconds(0)), std::nullopt);
}

TEST(UdpSocket, ReadsAddresses) {
  EXPECT_EQ(mavlink::parse_ipv4("127.0.0.1"), kLoopback);
  EXPECT_EQ(mavlink::parse_ipv4("localhost"), std::nullopt);
  EXPECT_EQ(mavlink::parse_ipv4("256.0.0.1"), std::nullopt);
}

}  // namespace
}  // namespace vinerow::controllers::ardupilot_link_test
