/// Bounds of what waits for a client.

#include <gtest/gtest.h>

#include "engine/live/outbox.h"

namespace vinerow::live::outbox_test {
namespace {

Frame of_bytes(std::size_t count, const std::string& head = "h") {
  return {true, head, std::make_shared<const std::vector<std::uint8_t>>(count)};
}

/// First characters of all frames.
std::string drain(Outbox& outbox) {
  std::string heads;
  while (const auto frame = outbox.take()) heads += frame->head.front();
  return heads;
}

TEST(Outbox, KeepsTheOrderAndWakesAnIdleSenderOnce) {
  int wakes = 0;
  Outbox outbox([&] { ++wakes; });
  outbox.add(FrameKind::kAnswer, {false, "a"});
  outbox.add(FrameKind::kMessage, {true, "b"});
  EXPECT_EQ(wakes, 1);
  EXPECT_EQ(outbox.take()->head, "a");
  EXPECT_EQ(outbox.take()->head, "b");
  EXPECT_FALSE(outbox.take());
  outbox.add(FrameKind::kMessage, {true, "c"});
  EXPECT_EQ(wakes, 2);
}

TEST(Outbox, DropsPicturesFirstThenMessagesNeverAnswers) {
  Outbox outbox([] {});
  constexpr std::size_t kSize = 1 << 20;
  for (int i = 0; i < 4; ++i) outbox.add(FrameKind::kPicture, of_bytes(kSize, "p"));
  EXPECT_TRUE(outbox.has_room());
  for (int i = 0; i < 20; ++i) outbox.add(FrameKind::kMessage, of_bytes(kSize, "m"));
  EXPECT_FALSE(outbox.has_room());
  outbox.add(FrameKind::kAnswer, {false, "answer"});
  outbox.miss();
  EXPECT_EQ(outbox.take_dropped(), 0) << "not before there is room again";
  EXPECT_EQ(drain(outbox), "ppmmmmmma") << "pictures up to 2 MB, messages up to 8 MB";
  EXPECT_EQ(outbox.take_dropped(), 2 + 14 + 1);
  EXPECT_EQ(outbox.take_dropped(), 0);
  EXPECT_TRUE(outbox.has_room());
}

TEST(Outbox, TakesOneLargeMessageAlone) {
  Outbox outbox([] {});
  outbox.add(FrameKind::kMessage, of_bytes(30 << 20));
  outbox.add(FrameKind::kMessage, of_bytes(1));
  EXPECT_EQ(drain(outbox), "h");
}

TEST(Outbox, NoticesAClientThatAsksWithoutReading) {
  Outbox outbox([] {});
  for (int i = 0; i < 64; ++i) outbox.add(FrameKind::kAnswer, of_bytes(1 << 20));
  EXPECT_TRUE(outbox.is_flooded());
}

}  // namespace
}  // namespace vinerow::live::outbox_test
