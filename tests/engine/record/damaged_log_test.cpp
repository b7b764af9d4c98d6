/// Logs that were cut, flipped or never were logs: what is whole is read, nothing crashes.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "engine/core/error.h"
#include "engine/record/log_reader.h"
#include "tests/engine/record/log_files.h"
#include "tests/engine/record/message_samples.h"
#include "tests/engine/record/raw_messages.h"

namespace vinerow::record::damaged_log_test {
namespace {

using test::bytes_of;
using test::TemporaryFile;

using Truths = std::map<std::int64_t, std::vector<std::uint8_t>>;

/// All truth messages by stamp.
Truths truths_of(const LogReader& log) {
  Truths truths;
  if (!log.has_topic("/rover/truth")) return truths;
  log.read<Odometry>("/rover/truth", [&](Time stamp, const Odometry& value) {
    truths[stamp.ns] = bytes_of(value);
  });
  return truths;
}

std::string error_of(const std::filesystem::path& file) {
  try {
    const LogReader log(file);
  } catch (const ConfigError& error) {
    return std::filesystem::path(error.what()).filename();
  }
  return "";
}

/// A log of several chunks.
std::vector<std::uint8_t> sample_log(const std::string& compression) {
  const TemporaryFile file;
  test::record_mission(file.path(),
                       {.compression = compression, .chunk_bytes = 30'000, .flush_wall_s = 1e6},
                       Time{600'000'000});
  return test::read_bytes(file.path());
}

bool is_subset(const Truths& part, const Truths& whole) {
  for (const auto& [stamp, bytes] : part) {
    const auto found = whole.find(stamp);
    if (found == whole.end() || found->second != bytes) return false;
  }
  return true;
}

TEST(DamagedLog, NamesWhatIsNoLog) {
  const TemporaryFile file;
  const std::string name = file.path().filename();
  EXPECT_EQ(error_of(file.path()), name + ": cannot be read: No such file or directory");
  test::write_bytes(file.path(), {});
  EXPECT_EQ(error_of(file.path()), name + ": not an MCAP file");
  const std::string text = "name: riseholme\nseed: 3\n";
  test::write_bytes(file.path(), {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  EXPECT_EQ(error_of(file.path()), name + ": not an MCAP file");
  const auto log = sample_log("zstd");
  test::write_bytes(file.path(), std::span(log).first(20));
  EXPECT_EQ(error_of(file.path()),
            name + ": an MCAP file that is cut off or damaged inside its first record");
  EXPECT_THROW(LogReader(std::filesystem::temp_directory_path()), ConfigError);
}

class DamagedLog : public ::testing::TestWithParam<std::string> {};

TEST_P(DamagedLog, CutAnywhereKeepsTheWholeChunks) {
  const auto bytes = sample_log(GetParam());
  const TemporaryFile file;
  test::write_bytes(file.path(), bytes);
  const Truths whole = truths_of(LogReader(file.path()));
  ASSERT_EQ(whole.size(), 12u);
  std::size_t before = 0;
  for (std::size_t size = 100; size < bytes.size(); size += 997) {
    test::write_bytes(file.path(), std::span(bytes).first(size));
    const LogReader log(file.path());
    EXPECT_FALSE(log.info().complete);
    const Truths part = truths_of(log);
    EXPECT_TRUE(is_subset(part, whole));
    // What a shorter file kept, a longer keeps; and from the front, without gaps.
    EXPECT_GE(part.size(), before);
    if (!part.empty()) {
      EXPECT_EQ(part.rbegin()->first, (static_cast<std::int64_t>(part.size()) - 1) * 50'000'000);
    }
    EXPECT_EQ(log.info().damaged, 0u);
    before = part.size();
  }
  EXPECT_EQ(before, whole.size());
}

TEST_P(DamagedLog, FlippedBitsNeverGiveWrongValues) {
  const auto bytes = sample_log(GetParam());
  const TemporaryFile file;
  test::write_bytes(file.path(), bytes);
  const Truths whole = truths_of(LogReader(file.path()));
  RandomStream random(1, "test", "flips");
  for (int i = 0; i < 150; ++i) {
    auto damaged = bytes;
    damaged[random.next_u64() % bytes.size()] ^=
        static_cast<std::uint8_t>(1u << (random.next_u64() % 8));
    // Every third also loses its tail, so that the walk is tried as well as the index.
    if (i % 3 == 0) damaged.resize(bytes.size() - 200 - random.next_u64() % 2000);
    test::write_bytes(file.path(), damaged);
    try {
      const LogReader log(file.path());
      EXPECT_TRUE(is_subset(truths_of(log), whole)) << i;
      test::read_raw(file.path(),
                     [](Time, const ChannelInfo&, const std::vector<std::uint8_t>&) {});
    } catch (const ConfigError&) {
      // The flip hit the header or the topic's type: said, not guessed.
    }
  }
}

TEST_P(DamagedLog, AChunkWithAWrongChecksumIsLeftOutAndCounted) {
  const auto bytes = sample_log(GetParam());
  const TemporaryFile file;
  // The first chunk's stored checksum: opcode 06 behind the channels.
  test::write_bytes(file.path(), bytes);
  const Truths whole = truths_of(LogReader(file.path()));
  std::size_t at = 8;
  while (bytes[at] != 0x06) {
    std::uint64_t length;
    std::memcpy(&length, &bytes[at + 1], 8);
    at += 9 + length;
  }
  auto damaged = bytes;
  damaged[at + 9 + 24] ^= 1;
  test::write_bytes(file.path(), damaged);
  const LogReader log(file.path());
  EXPECT_TRUE(log.info().complete);
  const Truths part = truths_of(log);
  EXPECT_TRUE(is_subset(part, whole));
  EXPECT_LT(part.size(), whole.size());
  EXPECT_GT(part.size(), 0u);
  EXPECT_EQ(log.info().damaged, 1u);
  ASSERT_EQ(log.info().warnings.size(), 1u);
  EXPECT_EQ(log.info().warnings[0], file.path().string() + ": the chunk at byte " +
                                        std::to_string(at) + " is damaged and was skipped");
  truths_of(log);  // a second reading counts nothing twice
  EXPECT_EQ(log.info().damaged, 1u);

  // The same without the summary.
  damaged.resize(damaged.size() - 1);
  test::write_bytes(file.path(), damaged);
  const LogReader cut(file.path());
  EXPECT_FALSE(cut.info().complete);
  EXPECT_EQ(truths_of(cut), part);
  EXPECT_EQ(cut.info().damaged, 1u);
}

INSTANTIATE_TEST_SUITE_P(Compressions, DamagedLog, ::testing::Values("zstd", "lz4", "none"));

TEST(DamagedLog, GarbageBehindTheMagicNeverCrashes) {
  const TemporaryFile file;
  RandomStream random(2, "test", "garbage");
  const auto head = sample_log("none");
  for (int i = 0; i < 200; ++i) {
    std::vector<std::uint8_t> bytes(head.begin(), head.begin() + 100);
    bytes.resize(8 + random.next_u64() % 92);
    for (std::size_t n = random.next_u64() % 3000; n > 0; --n) {
      // Small numbers are likelier to look like opcodes and lengths.
      const std::uint64_t word = random.next_u64();
      bytes.push_back(static_cast<std::uint8_t>(word % 3 == 0 ? word >> 32 : (word >> 32) % 16));
    }
    test::write_bytes(file.path(), bytes);
    try {
      const LogReader log(file.path());
      truths_of(log);
    } catch (const ConfigError&) {
    }
  }
}

TEST(DamagedLog, AWrongTopicOrTypeIsNamed) {
  const TemporaryFile file;
  test::record_mission(file.path(), {}, Time{10'000'000});
  const LogReader log(file.path());
  const auto message = [](const std::function<void()>& action) -> std::string {
    try {
      action();
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message([&] {
              log.read<Odometry>("/rover/truht", [](Time, const Odometry&) {});
            }).find("no topic '/rover/truht'; did you mean '/rover/truth'?"),
            std::string::npos);
  EXPECT_NE(message([&] { log.read<Odometry>("/rover/imu", [](Time, const Odometry&) {}); })
                .find("topic '/rover/imu' holds sensor_msgs/msg/Imu, which is not Odometry "
                      "(nav_msgs/msg/Odometry)"),
            std::string::npos);
}

// The real thing: a process that is killed while it records.
TEST(DamagedLog, AKilledRunLeavesAReadableLog) {
  const TemporaryFile file;
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    test::record_mission(file.path(), {.chunk_bytes = 50'000, .flush_wall_s = 0.02},
                         Time{std::numeric_limits<std::int64_t>::max() / 2});
    _exit(0);
  }
  std::error_code error;
  for (int i = 0; i < 2000; ++i) {
    const auto size = std::filesystem::file_size(file.path(), error);
    if (!error && size > 200'000) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));

  const LogReader log(file.path());
  EXPECT_FALSE(log.info().complete);
  EXPECT_EQ(log.info().metadata.at("scenario"), "mission.yaml");
  EXPECT_EQ(log.info().damaged, 0u);
  const Truths truths = truths_of(log);
  EXPECT_GT(truths.size(), 100u);
  EXPECT_EQ(truths.rbegin()->first, (static_cast<std::int64_t>(truths.size()) - 1) * 50'000'000);
}

}  // namespace
}  // namespace vinerow::record::damaged_log_test
