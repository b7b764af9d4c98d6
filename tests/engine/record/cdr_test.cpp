/// Known bytes: composed by hand from the rules of OMG CDR, not by our writer.

#include "engine/record/cdr.h"

#include <gtest/gtest.h>

#include <functional>
#include <sstream>
#include <vector>

#include "engine/record/ros_mapping.h"

namespace vinerow::record::cdr_test {
namespace {

/// "00 01 ff" -> bytes; "'text'" stands for its characters.
std::vector<std::uint8_t> bytes(const std::string& text) {
  std::vector<std::uint8_t> result;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (word.front() == '\'') {
      result.insert(result.end(), word.begin() + 1, word.end() - 1);
    } else {
      result.push_back(static_cast<std::uint8_t>(std::stoul(word, nullptr, 16)));
    }
  }
  return result;
}

std::vector<std::uint8_t> bytes(const ByteBuffer& buffer) {
  return {buffer.data(), buffer.data() + buffer.size()};
}

template <class T>
std::vector<std::uint8_t> message_bytes(const std::string& signal, Time stamp, const T& value) {
  ByteBuffer buffer;
  CdrWriter out(buffer);
  const FrameNames frames = FrameNames::of_signal(signal);
  RosMapping<T>::write(out, {frames, stamp}, value);
  return bytes(buffer);
}

TEST(Cdr, AlignsEveryNumberToItsSizeBehindTheHeader) {
  ByteBuffer buffer;
  CdrWriter out(buffer);
  out.add(std::uint8_t{0x11});
  out.add(std::uint16_t{0x2233});
  out.add(std::uint8_t{0x44});
  out.add(std::uint32_t{0x55667788});
  out.add(std::uint8_t{0x99});
  out.add(1.0);
  out.add(true);
  out.add(std::int32_t{-2});
  EXPECT_EQ(bytes(buffer), bytes("00 01 00 00 "
                                 "11 00 33 22 44 00 00 00 88 77 66 55 99 00 00 00 "
                                 "00 00 00 00 00 00 f0 3f 01 00 00 00 fe ff ff ff"));
}

// The origin of alignment is the byte behind this message's header, wherever the message lies.
TEST(Cdr, AlignsWithinTheMessageNotTheBuffer) {
  ByteBuffer buffer;
  buffer.add_zeros(3);
  CdrWriter out(buffer);
  out.add(std::uint8_t{1});
  out.add(std::uint32_t{2});
  EXPECT_EQ(bytes(buffer), bytes("00 00 00 00 01 00 00 01 00 00 00 02 00 00 00"));
}

TEST(Cdr, WritesStringsAndSequencesWithTheirCounts) {
  ByteBuffer buffer;
  CdrWriter out(buffer);
  out.add(std::string_view());
  out.add(std::string_view("abc"));
  out.add_count(0);
  out.add_doubles(nullptr, 0);
  out.add(std::uint8_t{7});
  EXPECT_EQ(bytes(buffer), bytes("00 01 00 00 01 00 00 00 00 00 00 00 04 00 00 00 'abc' 00 "
                                 "00 00 00 00 07"));
}

TEST(Cdr, ReadsBackAndStopsAtTheEnd) {
  const auto message = bytes("00 01 00 00 05 00 00 00 04 00 00 00 'abc' 00");
  CdrReader in(message);
  EXPECT_EQ(in.read<std::int32_t>(), 5);
  EXPECT_EQ(in.read_text(), "abc");
  EXPECT_TRUE(in.ok());
  EXPECT_EQ(in.read<double>(), 0.0);
  EXPECT_FALSE(in.ok());
}

TEST(Cdr, RefusesCountsThatCannotFit) {
  const auto message = bytes("00 01 00 00 ff ff ff ff 00 00 00 00");
  CdrReader count(message);
  EXPECT_EQ(count.read_count(8), 0u);
  EXPECT_FALSE(count.ok());
  CdrReader text(message);
  EXPECT_EQ(text.read_text(), "");
  EXPECT_FALSE(text.ok());
}

TEST(Cdr, RefusesOtherEncodings) {
  const auto big_endian = bytes("00 00 00 00 00 00 00 05");
  EXPECT_FALSE(CdrReader(big_endian).ok());
  const auto short_message = bytes("00 01");
  EXPECT_FALSE(CdrReader(short_message).ok());
}

// stamp 1.5 s = 1 s + 500000000 ns (0x1dcd6500); "r/base_link" and its zero are 12 bytes: the
// doubles begin at 4 + 4 + 4 + 12 = 24, aligned as it is.
TEST(RosMapping, TwistStampedBytes) {
  EXPECT_EQ(message_bytes("r/command", Time{1'500'000'000}, VelocityCommand{1.0, -2.0}),
            bytes("00 01 00 00 01 00 00 00 00 65 cd 1d 0c 00 00 00 'r/base_link' 00 "
                  "00 00 00 00 00 00 f0 3f 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
                  "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 c0"));
}

// One letter more: 25 bytes, 7 of padding.
TEST(RosMapping, TwistStampedBytesWithPadding) {
  EXPECT_EQ(message_bytes("ro/command", Time{2'000'000'001}, VelocityCommand{1.0, 0.0}),
            bytes("00 01 00 00 02 00 00 00 01 00 00 00 0d 00 00 00 'ro/base_link' 00 "
                  "00 00 00 00 00 00 00 "
                  "00 00 00 00 00 00 f0 3f 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
                  "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00"));
}

TEST(RosMapping, NamedValuesBytes) {
  EXPECT_EQ(message_bytes("r/wheels", Time{0}, NamedValues{{"a", "bcd"}, {1.0, 2.0}}),
            bytes("00 01 00 00 00 00 00 00 00 00 00 00 0c 00 00 00 'r/base_link' 00 "
                  "02 00 00 00 02 00 00 00 'a' 00 00 00 04 00 00 00 'bcd' 00 "
                  "02 00 00 00 00 00 00 00 00 00 f0 3f 00 00 00 00 00 00 00 40"));
}

TEST(RosMapping, LogBytes) {
  EXPECT_EQ(message_bytes("run/events", Time{0}, Event{Event::Level::kWarning, "ab", "c"}),
            bytes("00 01 00 00 00 00 00 00 00 00 00 00 1e 00 00 00 03 00 00 00 'ab' 00 00 "
                  "02 00 00 00 'c' 00 00 00 01 00 00 00 00 00 00 00 01 00 00 00 00 00 00 00 "
                  "00 00 00 00"));
}

// 2 x 0.25 rad, 0.25 m, 4 m, nothing seen: 0.5f, 0.25f, 4f, +inf.
TEST(RosMapping, RangeBytes) {
  RangeSample sample;
  sample.range_m = std::numeric_limits<double>::infinity();
  sample.min_range_m = 0.25;
  sample.max_range_m = 4.0;
  sample.half_angle_rad = 0.25;
  EXPECT_EQ(message_bytes("r/us", Time{0}, sample),
            bytes("00 01 00 00 00 00 00 00 00 00 00 00 05 00 00 00 'r/us' 00 00 00 00 "
                  "00 00 00 3f 00 00 80 3e 00 00 80 40 00 00 80 7f"));
}

// "map" ends at 16, the map's load time at 24; 0.5f; 3 x 2 cells; then 4 bytes of padding before
// the origin's doubles. The cells are single bytes behind their count.
TEST(RosMapping, OccupancyGridBytes) {
  OccupancyGrid grid;
  grid.columns = 3;
  grid.rows = 2;
  grid.cell_m = 0.5;
  grid.corner_W = {1.0, -2.0};
  grid.cells = {0, 1, 1, 1, 0, 0};
  EXPECT_EQ(message_bytes("run/map", Time{1'000'000'002}, grid),
            bytes("00 01 00 00 01 00 00 00 02 00 00 00 04 00 00 00 'map' 00 "
                  "01 00 00 00 02 00 00 00 00 00 00 3f 03 00 00 00 02 00 00 00 00 00 00 00 "
                  "00 00 00 00 00 00 f0 3f 00 00 00 00 00 00 00 c0 00 00 00 00 00 00 00 00 "
                  "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
                  "00 00 00 00 00 00 f0 3f 06 00 00 00 00 64 64 64 00 00"));
}

// ns "r/plan_tree" and its zero are 12 bytes from 20 to 32; id, type 5, action 0 end at 44, 4 bytes
// of padding; pose (identity) 48 to 104, scale to 128, colour to 144, lifetime to 152, frame_locked
// and 3 bytes to 156, the count of the points to 160; two points to 208; then colors, the empty
// texts (a length of 1 and the zero, then 3 bytes of padding), the texture's stamp and sequences.
TEST(RosMapping, LineListMarkerBytes) {
  LineList tree;
  tree.points_W = {{1.0, 2.0, 0.0}, {-2.0, 0.0, 0.0}};
  const auto message = message_bytes("r/plan_tree", Time{0}, tree);
  const auto part = [&](std::size_t from, std::size_t to) {  // offsets behind the encapsulation
    return std::vector<std::uint8_t>(message.begin() + 4 + static_cast<std::ptrdiff_t>(from),
                                     message.begin() + 4 + static_cast<std::ptrdiff_t>(to));
  };
  EXPECT_EQ(part(0, 48),
            bytes("00 00 00 00 00 00 00 00 04 00 00 00 'map' 00 0c 00 00 00 'r/plan_tree' 00 "
                  "00 00 00 00 05 00 00 00 00 00 00 00 00 00 00 00"));
  EXPECT_EQ(part(48, 104), bytes("00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
                                 "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
                                 "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
                                 "00 00 00 00 00 00 f0 3f"));
  EXPECT_EQ(part(144, 160), bytes("00 00 00 00 00 00 00 00 00 00 00 00 02 00 00 00"));
  EXPECT_EQ(part(160, 208), bytes("00 00 00 00 00 00 f0 3f 00 00 00 00 00 00 00 40 "
                                  "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 c0 "
                                  "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00"));
  EXPECT_EQ(part(208, message.size() - 4),
            bytes("00 00 00 00 01 00 00 00 00 00 00 00 "              // colors, texture_resource
                  "00 00 00 00 00 00 00 00 01 00 00 00 00 00 00 00 "  // texture.header
                  "01 00 00 00 00 00 00 00 00 00 00 00 "              // texture.format, data
                  "00 00 00 00 "                                      // uv_coordinates
                  "01 00 00 00 00 00 00 00 01 00 00 00 00 00 00 00 "  // text, mesh_resource
                  "01 00 00 00 00 00 00 00 00 00 00 00 00"));         // mesh_file, its use
}

TEST(RosMapping, LocalCommandBytes) {
  const LocalCommand command{LocalCommand::Mode::kDrive, -2.0, 1.0, -1.0, 2.0};
  EXPECT_EQ(message_bytes("r/local_command", Time{0}, command),
            bytes("00 01 00 00 00 00 00 00 00 00 00 00 0c 00 00 00 'r/base_link' 00 "
                  "01 00 00 00 00 00 00 00 00 00 00 00 00 00 00 c0 00 00 00 00 00 00 f0 3f "
                  "00 00 00 00 00 00 f0 bf 00 00 00 00 00 00 00 40"));
}

// "map" ends at 16; the joint's name, with its count, at 34, then 2 bytes of padding and the count
// of the points at 36 to 40. A point: count 1 and 4 bytes of padding, pose (yaw 0: the quaternion
// 0 0 0 1), count and padding, velocity, count and padding, acceleration, 0.5 s as two integers.
TEST(RosMapping, MultiDOFJointTrajectoryBytes) {
  ReferenceTrajectory reference;
  reference.dt_s = 0.5;
  reference.points.resize(2);
  reference.points[1].p_W = {1.0, 2.0, 0.0};
  reference.points[1].v_W = {0.0, -2.0, 0.0};
  reference.points[1].a_W = {0.0, 0.0, 1.0};
  reference.points[1].yaw_rate_radps = 2.0;
  const auto message = message_bytes("r/reference", Time{0}, reference);
  constexpr std::ptrdiff_t kBegin = 4 + 40, kPoint = 8 + 56 + 8 + 48 + 8 + 48 + 8;
  ASSERT_EQ(std::ssize(message), kBegin + 2 * kPoint);
  EXPECT_EQ(std::vector<std::uint8_t>(message.begin() + 4, message.begin() + kBegin),
            bytes("00 00 00 00 00 00 00 00 04 00 00 00 'map' 00 "
                  "01 00 00 00 0a 00 00 00 'base_link' 00 00 00 02 00 00 00"));
  EXPECT_EQ(std::vector<std::uint8_t>(message.begin() + kBegin + kPoint, message.end()),
            bytes("01 00 00 00 00 00 00 00 "
                  "00 00 00 00 00 00 f0 3f 00 00 00 00 00 00 00 40 00 00 00 00 00 00 00 00 "
                  "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
                  "00 00 00 00 00 00 f0 3f "
                  "01 00 00 00 00 00 00 00 "
                  "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 c0 00 00 00 00 00 00 00 00 "
                  "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 40 "
                  "01 00 00 00 00 00 00 00 "
                  "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 f0 3f "
                  "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
                  "00 00 00 00 00 65 cd 1d"));
}

// A grid whose sides do not agree with its cells is no grid.
TEST(RosMapping, RefusesGridsWhoseSidesDoNotFit) {
  OccupancyGrid grid;
  grid.columns = grid.rows = 2;
  grid.cells = {1, 0, 0, 1};
  const auto read_after = [&](const std::function<void(std::vector<std::uint8_t>&)>& damage) {
    ByteBuffer buffer;
    CdrWriter out(buffer);
    const FrameNames frames = FrameNames::of_signal("run/map");
    RosMapping<OccupancyGrid>::write_exact(out, {frames, Time{0}}, grid);
    std::vector<std::uint8_t> message = bytes(buffer);
    damage(message);
    CdrReader in(message);
    OccupancyGrid read;
    return RosMapping<OccupancyGrid>::read(in, frames, read);
  };
  constexpr std::size_t kColumns = 4 + 16 + 3 * 8, kRows = kColumns + 4;
  EXPECT_TRUE(read_after([](auto&) {}));
  EXPECT_FALSE(read_after([](auto& message) { message[kColumns] = 3; }));
  EXPECT_FALSE(read_after([](auto& message) { message.pop_back(); }));
  // No cells, and a side that no int holds.
  grid.columns = 0;
  grid.rows = 0;
  grid.cells.clear();
  EXPECT_FALSE(read_after([](auto& message) { message[kRows + 3] = 0xff; }));
}

// Stamps before zero: builtin_interfaces/Time counts nanoseconds forward.
TEST(RosMapping, NegativeStampBytes) {
  const auto message = message_bytes("run/events", Time{-1}, Event{});
  EXPECT_EQ(std::vector<std::uint8_t>(message.begin() + 4, message.begin() + 12),
            bytes("ff ff ff ff ff c9 9a 3b"));
}

}  // namespace
}  // namespace vinerow::record::cdr_test
