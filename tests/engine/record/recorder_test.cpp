#include "engine/record/recorder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "engine/core/error.h"
#include "engine/record/log_reader.h"
#include "tests/engine/record/log_files.h"
#include "tests/engine/record/raw_messages.h"
#include "tests/support/no_alloc.h"

namespace vinerow::record::recorder_test {
namespace {

using test::TemporaryFile;

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(Recorder, BeginsAsTheSpecificationSays) {
  const TemporaryFile file;
  { Recorder recorder(file.path(), {}, {}); }
  const std::vector<std::uint8_t> bytes = test::read_bytes(file.path());
  // Magic; Header record: profile "ros2", then the library.
  const std::uint8_t wanted[] = {0x89, 'M', 'C', 'A', 'P', 0x30, '\r', '\n', 0x01};
  ASSERT_GT(bytes.size(), 60u);
  EXPECT_TRUE(std::equal(std::begin(wanted), std::end(wanted), bytes.begin()));
  EXPECT_EQ(std::string(bytes.begin() + 17, bytes.begin() + 25), std::string("\4\0\0\0ros2", 8));
  EXPECT_EQ(std::string(bytes.begin() + 29, bytes.begin() + 37), "vinerow ");
  EXPECT_TRUE(std::equal(std::begin(wanted), std::begin(wanted) + 8, bytes.end() - 8));
}

TEST(Recorder, KeepsMetadataAttachmentsTopicsAndTimes) {
  const TemporaryFile file;
  test::record_mission(file.path(), {}, Time{2'000'000'000});
  const LogReader log(file.path());
  const LogInfo& info = log.info();
  EXPECT_TRUE(info.complete);
  EXPECT_EQ(info.metadata.at("scenario"), "mission.yaml");
  EXPECT_EQ(info.attachments.at("scenario.resolved.yaml"), "name: mission\n");
  EXPECT_EQ(info.first.ns, 0);
  EXPECT_EQ(info.last.ns, 1'990'000'000);  // the last IMU sample; the last tick has nothing due
  EXPECT_EQ(info.bytes, std::filesystem::file_size(file.path()));
  std::map<std::string, std::pair<std::string, std::uint64_t>> topics;
  std::uint64_t sum = 0;
  for (const ChannelInfo& channel : info.channels) {
    topics[channel.topic] = {channel.schema, channel.messages};
    sum += channel.messages;
  }
  EXPECT_EQ(info.messages, sum);
  using Topic = std::pair<std::string, std::uint64_t>;
  EXPECT_EQ(topics.at("/rover/truth"), Topic("nav_msgs/msg/Odometry", 40));
  EXPECT_EQ(topics.at("/rover/imu"), Topic("sensor_msgs/msg/Imu", 200));
  EXPECT_EQ(topics.at("/rover/gps"), Topic("sensor_msgs/msg/NavSatFix", 10));
  EXPECT_EQ(topics.at("/rover/gps/exact"), Topic("vinerow_msgs/msg/GnssFix", 10));
  EXPECT_EQ(topics.at("/rover/plan"), Topic("nav_msgs/msg/Path", 1));
  EXPECT_EQ(topics.at("/run/events"), Topic("rcl_interfaces/msg/Log", 1));
}

TEST(Recorder, ThinsByStampsExactly) {
  const TemporaryFile file;
  SignalBus bus;
  auto fast = bus.advertise<VelocityCommand>("rover/command", "test");
  {
    Recorder recorder(file.path(), {}, {});
    recorder.channels().add_signal(*bus.find("rover/command"), Duration{50'000'000});
    // 1 kHz for 10 s, written at every step: 20 Hz remain, on the exact nanosecond.
    for (std::int64_t ms = 0; ms < 10'000; ++ms) {
      fast.write(Time{ms * 1'000'000}, {static_cast<double>(ms), 0});
      recorder.record(Time{ms * 1'000'000});
    }
    EXPECT_EQ(recorder.message_count(), 200u);
  }
  std::int64_t wanted_ns = 0;
  LogReader(file.path())
      .read<VelocityCommand>("/rover/command", [&](Time stamp, const VelocityCommand& value) {
        EXPECT_EQ(stamp.ns, wanted_ns);
        EXPECT_EQ(value.v_mps, static_cast<double>(wanted_ns / 1'000'000));
        wanted_ns += 50'000'000;
      });
}

TEST(Recorder, StoresOnlyWhatWasWrittenSince) {
  const TemporaryFile file;
  SignalBus bus;
  auto command = bus.advertise<VelocityCommand>("rover/command", "test");
  Recorder recorder(file.path(), {}, {});
  recorder.channels().add_signal(*bus.find("rover/command"), Duration{0});
  recorder.record(Time{0});
  EXPECT_EQ(recorder.message_count(), 0u);
  command.write(Time{1}, {});
  recorder.record(Time{1});
  recorder.record(Time{2});
  EXPECT_EQ(recorder.message_count(), 1u);
  // A delayed sensor's stamps may go backwards; without thinning each counts.
  command.write(Time{0}, {});
  recorder.record(Time{3});
  EXPECT_EQ(recorder.message_count(), 2u);
}

std::vector<std::vector<std::uint8_t>> messages_of(const std::filesystem::path& file) {
  std::vector<std::vector<std::uint8_t>> messages;
  test::read_raw(
      file, [&](Time time, const ChannelInfo& channel, const std::vector<std::uint8_t>& data) {
        messages.push_back(data);
        messages.back().push_back(static_cast<std::uint8_t>(channel.id));
        for (int i = 0; i < 8; ++i) {
          messages.back().push_back(static_cast<std::uint8_t>(time.ns >> (8 * i)));
        }
      });
  return messages;
}

TEST(Recorder, FlushingByWallTimeChangesNoMessage) {
  const TemporaryFile rarely, always;
  test::record_mission(rarely.path(), {.flush_wall_s = 1e6}, Time{3'000'000'000});
  test::record_mission(always.path(), {.flush_wall_s = 0}, Time{3'000'000'000});
  EXPECT_EQ(messages_of(rarely.path()), messages_of(always.path()));
}

TEST(Recorder, WritesTheSameBytesTwice) {
  const TemporaryFile a, b;
  test::record_mission(a.path(), {.flush_wall_s = 1e6}, Time{3'000'000'000});
  test::record_mission(b.path(), {.flush_wall_s = 1e6}, Time{3'000'000'000});
  EXPECT_EQ(test::read_bytes(a.path()), test::read_bytes(b.path()));
}

TEST(Recorder, AllocatesNothingOnceWarm) {
  const TemporaryFile file;
  test::MissionSignals mission;
  Recorder recorder(file.path(), {.chunk_bytes = 200'000, .flush_wall_s = 1e6}, {});
  for (const auto& signal : mission.signals()) recorder.channels().add_signal(*signal, Duration{0});
  std::size_t allocations = 0;
  std::uint64_t chunks_begun = 0;
  std::uint64_t bytes = recorder.bytes_written();
  for (Time now; now.ns < 20'000'000'000; now = now + test::MissionSignals::kTick) {
    mission.write(now);
    const test::AllocationCounter counter;
    recorder.record(now);
    const std::size_t count = counter.count();
    if (recorder.bytes_written() != bytes) {
      bytes = recorder.bytes_written();  // closing a chunk adds its entry to the summary
      ++chunks_begun;
    } else if (chunks_begun > 2) {
      allocations += count;
    }
  }
  EXPECT_GT(chunks_begun, 5u);
  EXPECT_EQ(allocations, 0u);
}

// An hour of a rover's mission within 100 MB: two minutes of it, with noise in every number that
// has any, within a thirtieth. Commands, which the actuators repeat, are thinned to 20 Hz; battery
// and contacts, which change slowly, to 1 Hz. What is written once (path, its planner's tree, map)
// is counted once.
TEST(Recorder, AnHourFitsInto100MB) {
  const TemporaryFile file;
  test::MissionSignals mission;
  Recorder recorder(file.path(), {}, {});
  for (const auto& signal : mission.signals()) {
    const std::string& name = signal->name();
    const bool is_slow = name == "rover/battery" || name == "rover/contacts";
    const std::int64_t period_ms = is_slow ? 1000 : name == "rover/command" ? 50 : 0;
    const bool is_once = name == "rover/plan" || name == "rover/plan_tree" || name == "run/map";
    // A rover without a local planner, which does not fly.
    if (is_once || name == "rover/local_command" || name == "rover/reference") continue;
    recorder.channels().add_signal(*signal, Duration{period_ms * 1'000'000});
  }
  for (Time now; now.ns < 120'000'000'000; now = now + test::MissionSignals::kTick) {
    mission.write(now);
    recorder.record(now);
  }
  recorder.finish();
  // A path of 2000 points in both forms; a tree of 8000 branches, 0.2 MB uncompressed; 5 million
  // cells below 0.1 MB.
  const double once_MB = 0.2 + 0.2 + 0.1;
  const double hour_MB = static_cast<double>(recorder.bytes_written()) * 30 / 1e6 + once_MB;
  RecordProperty("hour_MB", std::to_string(hour_MB));
  EXPECT_LT(hour_MB, 100);
}

// Parcel F at 5 cm: 5 million cells, recorded in both forms and read back.
TEST(Recorder, AMapOfFiveMillionCellsIsSmallAndQuick) {
  const TemporaryFile file;
  OccupancyGrid grid;
  grid.columns = 2600;
  grid.rows = 2000;
  grid.cell_m = 0.05;
  grid.cells.resize(2600 * 2000);
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    // Rows that cross the grid at an angle, 0.6 m wide every 2.5 m.
    const double across_m = 0.05 * (0.8 * static_cast<double>(i / 2600) + 0.6 * (i % 2600));
    grid.cells[i] = std::fmod(across_m, 2.5) < 0.6 ? 1 : 0;
  }
  SignalBus bus;
  auto map = bus.advertise<OccupancyGrid>("run/map", "run");
  Recorder recorder(file.path(), {}, {});
  recorder.channels().add_signal(*bus.find("run/map"), Duration{0});
  map.write(Time{0}, grid);
  const auto start = std::chrono::steady_clock::now();
  recorder.record(Time{0});
  recorder.finish();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  RecordProperty("write_ms", std::to_string(1e3 * wall.count()));
  RecordProperty("map_MB", std::to_string(static_cast<double>(recorder.bytes_written()) / 1e6));
  // 30 ms and 0.05 MB where this was written, both forms and compression included.
  EXPECT_LT(wall.count(), 1.0);
  EXPECT_LT(recorder.bytes_written(), 300'000u);
  int count = 0;
  LogReader(file.path()).read<OccupancyGrid>("/run/map", [&](Time, const OccupancyGrid& read) {
    EXPECT_EQ(read.columns, 2600);
    EXPECT_EQ(read.rows, 2000);
    EXPECT_TRUE(read.cells == grid.cells);
    ++count;
  });
  EXPECT_EQ(count, 1);
}

TEST(Recorder, NamesWhatIsWrongWithItsOptions) {
  const TemporaryFile file;
  EXPECT_EQ(error_of([&] { Recorder(file.path(), {.compression = "gzip"}, {}); }),
            "compression of the log = 'gzip', must be zstd, lz4 or none");
  EXPECT_EQ(error_of([&] { Recorder("/nonexistent/folder/log.mcap", {}, {}); }),
            "log '/nonexistent/folder/log.mcap' cannot be written: No such file or directory");
}

TEST(Recorder, SaysThatTheDiskIsFullOnce) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  test::MissionSignals mission;
  Recorder recorder("/dev/full", {.flush_wall_s = 0}, {});
  for (const auto& signal : mission.signals()) recorder.channels().add_signal(*signal, Duration{0});
  mission.write(Time{0});
  const std::string error = error_of([&] { recorder.record(Time{0}); });
  EXPECT_NE(error.find("/dev/full: the log cannot be written: the disk is full"), std::string::npos)
      << error;
  EXPECT_EQ(error_of([&] { recorder.record(Time{5'000'000}); }), "");
  EXPECT_EQ(error_of([&] { recorder.finish(); }), "");
}

}  // namespace
}  // namespace vinerow::record::recorder_test
