// What a ground station does with an autopilot, against a vehicle that speaks MAVLink's mission and
// command protocols.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "controllers/autopilot/mavlink/ground_station.h"
#include "engine/mavlink/enums.h"

namespace vinerow::controllers::ground_station_test {
namespace {

using namespace mavlink;
using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

/// Behaves as an ArduPilot rover does, in steps of 0.1 s.
struct FakeVehicle {
  std::uint8_t type = kTypeGroundRover;
  double ready_at_s = 5.0;
  int loses = 0;  ///< number of frames of the ground station that are lost first
  std::uint8_t mission_result = kMissionAccepted;
  bool refuses_to_arm = false;
  std::string prearm;

  std::vector<MissionItemInt> items;
  std::size_t wanted = 0;
  std::uint32_t mode = 4;  // HOLD
  bool is_armed = false;
  bool has_started = false;
  int uploads = 0;
  std::vector<std::pair<float, float>> intervals;  ///< message, microseconds

  FrameWriter writer{Sender{1, 1}};
  FrameReader reader;
  std::vector<Bytes> to_station;

  template <class M>
  void send(const M& message) {
    const auto frame = writer.write(message);
    to_station.emplace_back(frame.begin(), frame.end());
  }

  void take(std::span<const std::uint8_t> bytes) {
    if (loses > 0) {
      --loses;
      return;
    }
    reader.read(bytes, [this](const Frame& frame) { answer(frame); });
  }

  void ask_or_accept() {
    if (wanted < items.size()) {
      MissionRequestInt request;
      request.target_system = 255;
      request.seq = static_cast<std::uint16_t>(wanted);
      return send(request);
    }
    MissionAck ack;
    ack.type = mission_result;
    send(ack);
  }

  void answer(const Frame& frame) {
    if (const auto count = read<MissionCount>(frame)) {
      ++uploads;
      items.assign(count->count, {});
      wanted = 0;
      ask_or_accept();
    } else if (const auto item = read<MissionItemInt>(frame)) {
      if (item->seq != wanted) return;
      items[wanted++] = *item;
      ask_or_accept();
    } else if (const auto command = read<CommandLong>(frame)) {
      CommandAck ack;
      ack.command = command->command;
      switch (command->command) {
        case kCommandSetMessageInterval:
          intervals.emplace_back(command->param1, command->param2);
          break;
        case kCommandSetMode:
          mode = static_cast<std::uint32_t>(command->param2);
          break;
        case kCommandArm:
          if (refuses_to_arm) {
            ack.result = kResultFailed;
            StatusText text;
            text.severity = 2;
            set_text(text.text, "Arm: Throttle not neutral");
            send(text);
          } else {
            is_armed = true;
          }
          break;
        case kCommandMissionStart:
          has_started = true;
          break;
        default:
          ack.result = kResultUnsupported;
      }
      send(ack);
    }
  }

  void step(double time_s) {
    Heartbeat heartbeat;
    heartbeat.type = type;
    heartbeat.autopilot = kAutopilotArdupilot;
    heartbeat.custom_mode = mode;
    heartbeat.base_mode = is_armed ? kModeFlagArmed : 0;
    send(heartbeat);
    for (const auto& [message, interval_us] : intervals) {
      if (message == Attitude::kId) send(Attitude{});
      if (message != LocalPositionNed::kId) continue;
      LocalPositionNed position;
      position.x = static_cast<float>(time_s);
      send(position);
    }
    SysStatus status;
    if (time_s >= ready_at_s) status.onboard_control_sensors_health = kSensorPrearmCheck;
    send(status);
    if (!prearm.empty() && time_s < ready_at_s) {
      StatusText text;
      text.severity = 2;
      set_text(text.text, prearm);
      send(text);
    }
  }
};

std::vector<MissionItemInt> mission(int count) {
  std::vector<MissionItemInt> items(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    items[i].command = 16;  // waypoint
    items[i].x = 500'000'000 + i;
  }
  return items;
}

struct Bench {
  explicit Bench(int items, GroundStationOptions options = {}) {
    options.mission = mission(items);
    station.emplace(options, [this](std::span<const std::uint8_t> frame) { vehicle.take(frame); });
  }
  /// @param each  after each step
  void run(
      double seconds, const std::function<void()>& each = [] {}) {
    for (const double end_s = time_s + seconds; time_s < end_s; time_s += 0.1) {
      const Time now{static_cast<std::int64_t>(time_s * 1e9)};
      vehicle.step(time_s);
      for (std::size_t i = 0; i < vehicle.to_station.size(); ++i) {
        const Bytes bytes = vehicle.to_station[i];  // an answer may add more
        reader.read(bytes, [&](const Frame& frame) { station->take(now, frame); });
      }
      vehicle.to_station.clear();
      station->step(now);
      each();
    }
  }
  FakeVehicle vehicle;
  FrameReader reader;
  std::optional<GroundStation> station;
  double time_s = 0.0;
};

TEST(GroundStation, UploadsArmsAndStarts) {
  Bench bench(12);
  bench.run(4.5);
  EXPECT_EQ(bench.vehicle.uploads, 0) << "its own checks have not let it be armed yet";
  bench.run(5.0);
  EXPECT_EQ(bench.station->failure(), "");
  EXPECT_EQ(bench.vehicle.uploads, 1);
  ASSERT_EQ(bench.vehicle.items.size(), 12u);
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(bench.vehicle.items[i].seq, i);
    EXPECT_EQ(bench.vehicle.items[i].x, 500'000'000 + i);
    EXPECT_EQ(bench.vehicle.items[i].target_system, 1);
  }
  EXPECT_EQ(bench.vehicle.mode, 10u);
  EXPECT_TRUE(bench.vehicle.is_armed);
  EXPECT_TRUE(bench.vehicle.has_started);
  EXPECT_FALSE(bench.station->finished());
  // Attitude and position at 10 Hz, status at 1 Hz: message and microseconds.
  EXPECT_THAT(bench.vehicle.intervals,
              ::testing::ElementsAre(std::pair(30.0F, 1e5F), std::pair(32.0F, 1e5F),
                                     std::pair(1.0F, 1e6F)));
  ASSERT_TRUE(bench.station->estimate());
  EXPECT_NEAR(bench.station->estimate()->position.x, bench.time_s, 0.2);

  MissionItemReached reached;
  reached.seq = 11;
  bench.vehicle.send(reached);
  bench.run(0.2);
  EXPECT_TRUE(bench.station->finished());
  EXPECT_EQ(bench.station->items_reached(), 12);
}

TEST(GroundStation, RepeatsWhatIsLost) {
  Bench bench(3);
  bench.vehicle.loses = 5;  // the requests for streams twice, but one
  bench.run(9.0);
  EXPECT_EQ(bench.station->failure(), "");
  EXPECT_TRUE(bench.vehicle.has_started);
}

TEST(GroundStation, EndOfTheFlightIsItsDisarming) {
  Bench bench(3);
  bench.run(10.0);
  EXPECT_FALSE(bench.station->finished());
  bench.vehicle.is_armed = false;
  bench.run(0.2);
  EXPECT_TRUE(bench.station->finished());
}

TEST(GroundStation, SaysWhyThereIsNoMission) {
  GroundStationOptions hurried;
  hurried.ready_timeout_s = 3.0;
  Bench slow(2, hurried);
  slow.vehicle.prearm = "PreArm: GPS 1: Bad fix";
  slow.run(4.0);
  EXPECT_EQ(slow.station->failure(), "was not ready to be armed for 3 s (PreArm: GPS 1: Bad fix)");

  Bench refused(2);
  refused.vehicle.mission_result = kMissionInvalid;
  refused.run(6.0);
  EXPECT_EQ(refused.station->failure(), "refused the mission: an item is invalid");

  Bench unarmed(2);
  unarmed.vehicle.refuses_to_arm = true;
  unarmed.run(20.0);
  EXPECT_EQ(unarmed.station->failure(), "was not armed for 10 s (Arm: Throttle not neutral)");

  Bench boat(2);
  boat.vehicle.type = 11;
  boat.run(6.0);
  EXPECT_EQ(boat.station->failure(), "is a vehicle of type 11, for which no mode AUTO is known");
}

TEST(GroundStation, WithoutAMissionItOnlyListens) {
  Bench bench(0);
  bench.run(10.0);
  EXPECT_EQ(bench.vehicle.uploads, 0);
  EXPECT_FALSE(bench.vehicle.is_armed);
  EXPECT_TRUE(bench.station->estimate());
}

}  // namespace
}  // namespace vinerow::controllers::ground_station_test
