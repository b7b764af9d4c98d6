#pragma once
/// Files of the log tests.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "engine/record/recorder.h"
#include "tests/engine/record/mission_signals.h"

namespace vinerow::test {

/// A file of this test alone, removed with the object.
class TemporaryFile {
 public:
  TemporaryFile() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    static int count = 0;
    std::string name = std::string("vinerow_") + info->test_suite_name() + "_" + info->name() +
                       "_" + std::to_string(count++) + ".mcap";
    for (char& c : name) c = c == '/' ? '_' : c;
    path_ = std::filesystem::path(::testing::TempDir()) / name;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

inline void write_bytes(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
}

/// Records the mission up to `end` (not included).
inline void record_mission(const std::filesystem::path& file,
                           const record::RecorderOptions& options, Time end) {
  MissionSignals mission;
  record::Recorder recorder(file, options, {{"scenario", "mission.yaml"}, {"seed", "1"}});
  for (const auto& signal : mission.signals()) recorder.channels().add_signal(*signal, Duration{0});
  for (Time now; now < end; now = now + MissionSignals::kTick) {
    mission.write(now);
    recorder.record(now);
  }
  recorder.add_attachment("scenario.resolved.yaml", "application/yaml", "name: mission\n");
  recorder.finish();
}

}  // namespace vinerow::test
