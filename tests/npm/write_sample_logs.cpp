/// write_sample_logs FOLDER: logs for other readers to check. For every compression a whole one of
/// 10 s, and the one of a child that is killed while it records.

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <thread>

#include "engine/record/recorder.h"
#include "tests/engine/record/mission_signals.h"

namespace {

using vinerow::Duration;
using vinerow::Time;

void record_until(const std::filesystem::path& file, const std::string& compression, Time end) {
  vinerow::test::MissionSignals mission;
  vinerow::record::Recorder recorder(
      file, {.compression = compression, .chunk_bytes = 200'000, .flush_wall_s = 0.05},
      {{"scenario", "mission.yaml"}, {"seed", "1"}});
  for (const auto& signal : mission.signals()) recorder.channels().add_signal(*signal, Duration{0});
  for (Time now; now < end; now = now + vinerow::test::MissionSignals::kTick) {
    mission.write(now);
    recorder.record(now);
  }
  recorder.add_attachment("scenario.resolved.yaml", "application/yaml", "name: mission\n");
  recorder.finish();
}

/// @returns false if the child ended before it could be killed
bool record_killed(const std::filesystem::path& file, const std::string& compression) {
  std::filesystem::remove(file);
  const pid_t child = fork();
  if (child < 0) return false;
  if (child == 0) {
    record_until(file, compression, Time{std::numeric_limits<std::int64_t>::max() / 2});
    _exit(0);
  }
  // A file that holds several chunks behind the map's, at most 20 s from now.
  for (int i = 0; i < 20'000; ++i) {
    std::error_code error;
    const auto size = std::filesystem::file_size(file, error);
    if (!error && size > 3'000'000) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: write_sample_logs FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  for (const std::string compression : {"zstd", "lz4", "none"}) {
    record_until(folder / (compression + ".mcap"), compression, Time{10'000'000'000});
    if (!record_killed(folder / (compression + "_killed.mcap"), compression)) {
      std::fprintf(stderr, "the recording child was not killed\n");
      return 1;
    }
  }
  return 0;
}
