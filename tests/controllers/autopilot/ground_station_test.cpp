// What a ground station does with an autopilot, against a vehicle that speaks MAVLink's mission and
// command protocols.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "controllers/autopilot/mavlink/ground_station.h"
#include "engine/mavlink/enums.h"
#include "tests/controllers/autopilot/fake_vehicle.h"

namespace vinerow::controllers::ground_station_test {
namespace {

using namespace mavlink;
using autopilot_fake::FakeVehicle;
using Bytes = FakeVehicle::Bytes;
using ::testing::HasSubstr;

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
    options.expects_mission = items > 0;
    station.emplace(options, [this](std::span<const std::uint8_t> frame) { vehicle.take(frame); });
    station->fly(mission(items));
  }
  /// @param each  after each step
  void run(
      double seconds, const std::function<void()>& each = [] {}) {
    for (const double end_s = time_s + seconds; time_s < end_s; time_s += 0.1) {
      const Time now{static_cast<std::int64_t>(time_s * 1e9)};
      vehicle.position.x = static_cast<float>(time_s);
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
  // State of its estimator, attitude, position and navigation at 10 Hz, status at 1 Hz: message and
  // microseconds.
  EXPECT_THAT(bench.vehicle.intervals,
              ::testing::ElementsAre(std::pair(193.0F, 1e5F), std::pair(30.0F, 1e5F),
                                     std::pair(32.0F, 1e5F), std::pair(62.0F, 1e5F),
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

  hurried.ready_timeout_s = 10.0;
  Bench unarmed(2, hurried);
  unarmed.vehicle.refuses_to_arm = true;
  unarmed.run(20.0);
  EXPECT_EQ(unarmed.station->failure(), "was not armed for 10 s (Arm: Throttle not neutral)");

  Bench boat(2);
  boat.vehicle.type = 11;
  boat.run(6.0);
  EXPECT_EQ(boat.station->failure(), "is a vehicle of type 11, whose mode for missions is unknown");
}

TEST(GroundStation, SetsParametersFirst) {
  GroundStationOptions options;
  options.parameters = {{"WP_SPEED", 1.5}, {"CRUISE_SPEED", 2.0}};
  Bench bench(2, options);
  bench.vehicle.parameters = {{"WP_SPEED", 5.0F}, {"CRUISE_SPEED", 5.0F}, {"OTHER", 7.0F}};
  bench.run(9.0);
  EXPECT_EQ(bench.station->failure(), "");
  EXPECT_THAT(bench.vehicle.parameters,
              ::testing::ElementsAre(std::pair("CRUISE_SPEED", 2.0F), std::pair("OTHER", 7.0F),
                                     std::pair("WP_SPEED", 1.5F)));
  EXPECT_TRUE(bench.vehicle.has_started);

  options.parameters = {{"NO_SUCH", 1.0}};
  Bench unknown(0, options);
  unknown.run(11.0);
  EXPECT_EQ(unknown.station->failure(), "has no parameter NO_SUCH: it gave no answer for 10 s");

  options.parameters = {{"FIXED", 1.0}};
  Bench fixed(0, options);
  fixed.vehicle.parameters = {{"FIXED", 3.0F}};
  fixed.run(3.0);
  EXPECT_EQ(fixed.station->failure(), "keeps its parameter FIXED at 3 instead of 1");
}

TEST(GroundStation, SetsWholeNumbersOfPx4ByTheirBytes) {
  GroundStationOptions options;
  options.parameters = {{"COM_RC_IN_MODE", 4.0}, {"NAV_ACC_RAD", 0.5}, {"NAV_DLL_ACT", 0.0}};
  Bench bench(2, options);
  bench.vehicle.autopilot = kAutopilotPx4;
  bench.vehicle.parameters = {{"NAV_ACC_RAD", 10.0F}};
  bench.vehicle.whole_parameters = {{"COM_RC_IN_MODE", 1}, {"NAV_DLL_ACT", 0}};
  bench.run(9.0);
  EXPECT_EQ(bench.station->failure(), "");
  EXPECT_EQ(bench.vehicle.whole_parameters.at("COM_RC_IN_MODE"), 4);
  EXPECT_EQ(bench.vehicle.parameters.at("NAV_ACC_RAD"), 0.5F);
  EXPECT_TRUE(bench.vehicle.has_started);
  EXPECT_EQ(bench.vehicle.mode, 4u << 24 | 4u << 16) << "main mode auto, sub mode mission";

  options.parameters = {{"NO_SUCH", 1.0}};
  Bench unknown(0, options);
  unknown.vehicle.autopilot = kAutopilotPx4;
  unknown.run(11.0);
  EXPECT_EQ(unknown.station->failure(), "has no parameter NO_SUCH: it gave no answer for 10 s");
}

TEST(GroundStation, SendsCommandsInTime) {
  GroundStationOptions options;
  options.commands = {{2.0, 183, {5.0, 1900.0}}, {4.0, 2500, {}}};
  Bench bench(0, options);
  bench.run(1.9);
  EXPECT_TRUE(bench.vehicle.other_commands.empty());
  bench.run(0.3);
  ASSERT_EQ(bench.vehicle.other_commands.size(), 1u);
  EXPECT_EQ(bench.vehicle.other_commands[0].command, 183);
  EXPECT_EQ(bench.vehicle.other_commands[0].param1, 5.0F);
  EXPECT_EQ(bench.vehicle.other_commands[0].param2, 1900.0F);
  EXPECT_EQ(bench.vehicle.other_commands[0].param3, 0.0F);
  bench.run(2.0);
  EXPECT_EQ(bench.vehicle.other_commands.size(), 2u);
}

TEST(GroundStation, RefusesFirmwareOfAnotherVehicle) {
  GroundStationOptions options;
  options.vehicle_type = kTypeFixedWing;
  Bench bench(0, options);
  bench.run(1.0);
  EXPECT_EQ(bench.station->failure(), "is firmware for a rover, and this is a fixed wing");
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
