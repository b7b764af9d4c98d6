// Frames of MAVLink. That layouts and values are those of the standard, node-mavlink judges
// (tests/npm/check_mavlink.mjs).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "engine/mavlink/dialect.h"
#include "engine/mavlink/frame.h"
#include "engine/mavlink/messages.h"

namespace vinerow::mavlink::frame_test {
namespace {

using ::testing::ElementsAre;
using Bytes = std::vector<std::uint8_t>;

Bytes copy(std::span<const std::uint8_t> bytes) {
  return {bytes.begin(), bytes.end()};
}

Attitude attitude() {
  Attitude message;
  message.time_boot_ms = 1234;
  message.roll = 0.25F;
  message.yawspeed = -1.5F;
  return message;
}

/// Messages that a reader finds, as "id:sequence".
struct Found {
  FrameReader reader;
  std::vector<std::string> frames;
  void read(std::span<const std::uint8_t> bytes) {
    reader.read(bytes, [this](const Frame& frame) {
      frames.push_back(std::to_string(frame.id) + ":" + std::to_string(frame.sequence));
    });
  }
};

TEST(MavlinkCrc, IsThatOfTheStandard) {
  // Check value of CRC-16/MCRF4XX in the catalogue of parametrised CRC algorithms.
  Crc16 crc;
  crc.add(std::string_view("123456789"));
  EXPECT_EQ(crc.value(), 0x6F91);
}

TEST(MavlinkFrame, HasTheBytesOfTheStandard) {
  // A heartbeat of a ground station: these bytes are what node-mavlink 2.3.0 makes of it.
  FrameWriter writer({255, 190});
  Heartbeat heartbeat;
  heartbeat.type = 6;
  heartbeat.autopilot = 8;
  const Bytes frame = copy(writer.write(heartbeat));
  EXPECT_THAT(frame,
              ElementsAre(253, 9, 0, 0, 0, 255, 190, 0, 0, 0, 0, 0, 0, 0, 6, 8, 0, 0, 3, 92, 43));
}

TEST(MavlinkFrame, LeavesOutZerosAtTheEnd) {
  FrameWriter writer({});
  EXPECT_EQ(writer.write(CommandLong{}).size(), 10u + 1 + 2);
  CommandLong command;
  command.param1 = 1.0F;  // the first of the wire: bytes 00 00 80 3F
  EXPECT_EQ(writer.write(command).size(), 10u + 4 + 2);
}

TEST(MavlinkFrame, KeepsWhatItIsGiven) {
  FrameWriter writer({});
  const Bytes frame = copy(writer.write(attitude()));
  FrameReader reader;
  int count = 0;
  reader.read(frame, [&](const Frame& found) {
    ++count;
    EXPECT_FALSE(read<Heartbeat>(found));
    const auto message = read<Attitude>(found);
    ASSERT_TRUE(message);
    EXPECT_EQ(message->time_boot_ms, 1234u);
    EXPECT_EQ(message->roll, 0.25F);
    EXPECT_EQ(message->pitch, 0.0F);
    EXPECT_EQ(message->yawspeed, -1.5F);
  });
  EXPECT_EQ(count, 1);
}

TEST(MavlinkReader, FindsFramesHoweverTheyAreCut) {
  FrameWriter writer({});
  Bytes stream = {0, 1, 2, 0xFE, 0xFD};  // garbage with the starts of both versions
  for (int k = 0; k < 20; ++k) {
    const Bytes frame = copy(writer.write(attitude()));
    stream.insert(stream.end(), frame.begin(), frame.end());
  }
  for (const std::size_t piece : {1u, 2u, 7u, 64u, 1000u, 5000u}) {
    Found found;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      found.read(std::span(stream).subspan(at, std::min(piece, stream.size() - at)));
    }
    // The starts in the garbage promise an unknown message, which is skipped: at most kMaxFrame
    // bytes.
    ASSERT_GE(found.frames.size(), 20 - kMaxFrame / 40) << piece;
    EXPECT_EQ(found.frames.back(), "30:19") << piece;
  }
}

TEST(MavlinkReader, RefusesDamagedFramesAndGoesOn) {
  FrameWriter writer({});
  const Bytes good = copy(writer.write(attitude()));
  for (std::size_t at = 1; at < good.size(); ++at) {
    Bytes stream = good;
    stream[at] ^= 0x10;
    for (int k = 0; k < 12; ++k) stream.insert(stream.end(), good.begin(), good.end());
    Found found;
    found.read(stream);
    for (const std::string& frame : found.frames) EXPECT_EQ(frame, "30:0") << at;
    EXPECT_GE(found.frames.size(), 4u) << at;  // a wrong length can hide some
    const auto& losses = found.reader.losses();
    EXPECT_GE(losses.wrong_crc + losses.unknown, 1u) << at;
  }
}

TEST(MavlinkReader, SkipsSignatures) {
  FrameWriter writer({});
  Bytes frame = copy(writer.write(attitude()));
  frame[2] = 1;  // the flag counts in the CRC
  Crc16 crc;
  crc.add(std::span<const std::uint8_t>(frame).subspan(1, frame.size() - 3));
  crc.add(crc_extra<Attitude>());
  frame[frame.size() - 2] = static_cast<std::uint8_t>(crc.value() & 0xFF);
  frame[frame.size() - 1] = static_cast<std::uint8_t>(crc.value() >> 8);
  frame.insert(frame.end(), 13, 0xFD);
  const Bytes next = copy(writer.write(Heartbeat{}));
  frame.insert(frame.end(), next.begin(), next.end());
  Found found;
  found.read(frame);
  EXPECT_THAT(found.frames, ElementsAre("30:0", "0:1"));
}

TEST(MavlinkReader, CountsMessagesThatItDoesNotKnow) {
  const Bytes unknown = {0xFD, 1, 0, 0, 5, 1, 1, 0xFF, 0xFF, 0, 7, 0xAA, 0xBB};
  Found found;
  found.read(unknown);
  FrameWriter writer({});
  found.read(writer.write(Heartbeat{}));
  EXPECT_THAT(found.frames, ElementsAre("0:0"));
  EXPECT_EQ(found.reader.losses().unknown, 1u);
}

TEST(MavlinkReader, GarbageIsNoFrame) {
  std::mt19937 random(1);
  Found found;
  Bytes garbage(200'000);
  for (std::uint8_t& byte : garbage) byte = static_cast<std::uint8_t>(random());
  found.read(garbage);
  // A CRC of 16 bits lets one of 65,536 starts pass.
  EXPECT_LE(found.frames.size(), 2u);
}

TEST(MavlinkText, IsCutAndEndsAtAZero) {
  StatusText message;
  const std::string text(60, 'x');
  EXPECT_EQ(set_text(message.text, text), std::string(10, 'x'));
  EXPECT_EQ(text_of(message.text), std::string(50, 'x'));
  EXPECT_EQ(set_text(message.text, "short"), "");
  EXPECT_EQ(text_of(message.text), "short");
}

TEST(MavlinkDialect, IsSortedAndWithoutRepetition) {
  const auto all = known_messages();
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_LT(all[i - 1].id, all[i].id);
  EXPECT_STREQ(find_message(0)->name, "HEARTBEAT");
  EXPECT_EQ(find_message(12), nullptr);
  EXPECT_EQ(find_message(1'000'000), nullptr);
}

}  // namespace
}  // namespace vinerow::mavlink::frame_test
