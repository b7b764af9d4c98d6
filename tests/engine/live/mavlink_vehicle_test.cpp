// A vehicle as ground stations see it: rates, mission protocol and texts as MAVLink's guide has
// them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "engine/live/mavlink_vehicle.h"
#include "engine/mavlink/enums.h"

namespace vinerow::live::mavlink_vehicle_test {
namespace {

using namespace mavlink;
using ::testing::ElementsAre;

struct Station : MavlinkCommands {
  std::string take_mission(const std::vector<MissionItemInt>& items) override {
    taken = items;
    return refusal;
  }
  std::string start_mission() override { return ++starts, refusal; }
  std::string pause(bool pauses) override { return is_paused = pauses, refusal; }
  std::string set_speed(double value) override {
    speed_ = value;
    return value < 0.0 ? "too slow" : "";
  }
  double speed() const override { return speed_; }

  Station()
      : vehicle({.sender = {3, 1}, .type = kTypeGroundRover, .name = "rover"}, *this,
                [this](std::span<const std::uint8_t> frame) { hear(frame); }) {}

  void hear(std::span<const std::uint8_t> bytes) {
    reader.read(bytes, [this](const mavlink::Frame& frame) {
      EXPECT_EQ(frame.sender, (Sender{3, 1}));
      ++counts[frame.id];
      if (const auto request = read<MissionRequestInt>(frame)) requests.push_back(request->seq);
      if (const auto ack = read<MissionAck>(frame)) acks.push_back(ack->type);
      if (const auto ack = read<CommandAck>(frame)) results.push_back(ack->result);
      if (const auto text = read<StatusText>(frame)) texts.push_back(*text);
      if (const auto count = read<MissionCount>(frame)) items_offered = count->count;
      if (const auto item = read<MissionItemInt>(frame)) item_x.push_back(item->x);
    });
  }
  template <class M>
  void send(M message, std::uint8_t to = 3) {
    message.target_system = to;
    FrameReader other;
    other.read(writer.write(message), [this](const mavlink::Frame& frame) { vehicle.take(frame); });
  }
  void send_count(int count, std::uint8_t mission_type = 0) {
    MissionCount message;
    message.count = static_cast<std::uint16_t>(count);
    message.mission_type = mission_type;
    send(message);
  }
  void send_item(int number) {
    MissionItemInt item;
    item.seq = static_cast<std::uint16_t>(number);
    item.x = 100 + number;
    send(item);
  }

  std::string refusal;
  std::vector<MissionItemInt> taken;
  int starts = 0;
  bool is_paused = false;
  double speed_ = 1.0;
  FrameWriter writer{Sender{255, 190}};
  FrameReader reader;
  std::map<std::uint32_t, int> counts;
  std::vector<int> requests, acks, results, item_x;
  std::vector<StatusText> texts;
  int items_offered = -1;
  MavlinkVehicle vehicle;
};

TEST(MavlinkVehicle, ReportsAtTheUsualRates) {
  Station station;
  for (int k = 0; k < 1000; ++k) {  // 10 s
    MavlinkState state;
    state.time = Time{k * 10'000'000LL};
    station.vehicle.report(state);
  }
  EXPECT_EQ(station.counts[Heartbeat::kId], 10);
  EXPECT_EQ(station.counts[SysStatus::kId], 10);
  EXPECT_EQ(station.counts[Attitude::kId], 100);
  EXPECT_EQ(station.counts[GlobalPositionInt::kId], 100);
  EXPECT_EQ(station.counts[VfrHud::kId], 40);
  EXPECT_EQ(station.counts[HomePosition::kId], 1);
  EXPECT_EQ(station.reader.losses().wrong_crc + station.reader.losses().bytes, 0u);
}

TEST(MavlinkVehicle, TakesAMissionItemByItem) {
  Station station;
  station.send_count(3);
  EXPECT_THAT(station.requests, ElementsAre(0));
  station.send_item(0);
  station.send_item(0);  // its request was answered twice
  station.send_item(2);  // the one before was lost
  EXPECT_THAT(station.requests, ElementsAre(0, 1, 1, 1));
  station.vehicle.remind();
  EXPECT_THAT(station.requests, ElementsAre(0, 1, 1, 1, 1));
  station.send_item(1);
  station.send_item(2);
  EXPECT_THAT(station.acks, ElementsAre(kMissionAccepted));
  ASSERT_EQ(station.taken.size(), 3u);
  EXPECT_EQ(station.taken[2].x, 102);

  // And gives it back.
  station.send(MissionRequestList{});
  EXPECT_EQ(station.items_offered, 3);
  for (int k = 0; k < 3; ++k) {
    MissionRequestInt request;
    request.seq = static_cast<std::uint16_t>(k);
    station.send(request);
  }
  EXPECT_THAT(station.item_x, ElementsAre(100, 101, 102));
  MissionRequestInt beyond;
  beyond.seq = 3;
  station.send(beyond);
  EXPECT_THAT(station.acks, ElementsAre(kMissionAccepted, kMissionInvalidSequence));
}

TEST(MavlinkVehicle, RefusesWithASentence) {
  Station station;
  station.refusal = "rover follows its scenario";
  station.send_count(1);
  station.send_item(0);
  station.send_count(2, 1);    // fences
  station.send_count(60'000);  // more than it has room for
  EXPECT_THAT(station.acks, ElementsAre(kMissionDenied, kMissionUnsupported, kMissionNoSpace));
  CommandLong start;
  start.command = kCommandMissionStart;
  station.send(start);
  start.command = 42;
  station.send(start);
  EXPECT_THAT(station.results, ElementsAre(kResultDenied, kResultUnsupported));
  ASSERT_FALSE(station.texts.empty());
  EXPECT_EQ(text_of(station.texts[0].text), "rover follows its scenario");
  EXPECT_EQ(station.texts[0].severity, kSeverityWarning);
}

TEST(MavlinkVehicle, GivesUpAnUploadThatStops) {
  Station station;
  station.send_count(2);
  for (int k = 0; k < 10; ++k) station.vehicle.remind();
  EXPECT_EQ(station.requests.size(), 6u);
  station.send_item(0);
  EXPECT_EQ(station.requests.size(), 6u);
}

TEST(MavlinkVehicle, HearsOnlyWhatIsForIt) {
  Station station;
  CommandLong pause;
  pause.command = kCommandPauseContinue;
  station.send(pause, 4);
  EXPECT_FALSE(station.is_paused);
  station.send(pause, 0);  // to all
  EXPECT_TRUE(station.is_paused);
  pause.param1 = 1.0F;
  station.send(pause);
  EXPECT_FALSE(station.is_paused);
  CommandLong strange;
  strange.command = kCommandRequestMessage;
  for (const float id : {std::numeric_limits<float>::quiet_NaN(), -1.0F, 1e30F}) {
    strange.param1 = id;
    station.send(strange);
  }
  EXPECT_EQ(station.results.size(), 5u);
}

TEST(MavlinkVehicle, LongTextsComeInChunks) {
  Station station;
  const std::string sentence(120, 'x');
  station.vehicle.say(kSeverityInfo, sentence);
  station.vehicle.say(kSeverityInfo, "short");
  ASSERT_EQ(station.texts.size(), 4u);
  std::string joined;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NE(station.texts[k].id, 0);
    EXPECT_EQ(station.texts[k].id, station.texts[0].id);
    EXPECT_EQ(station.texts[k].chunk_seq, k);
    joined += text_of(station.texts[k].text);
  }
  EXPECT_EQ(joined, sentence);
  EXPECT_EQ(station.texts[3].id, 0);
}

}  // namespace
}  // namespace vinerow::live::mavlink_vehicle_test
