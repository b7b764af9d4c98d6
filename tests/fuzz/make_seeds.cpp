/// make_seeds FOLDER: writes the seeds of the fuzz targets of live runs and of autopilots into
/// FOLDER/live and FOLDER/autopilot.

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include "tests/fuzz/live_seeds.h"
#include "tests/fuzz/read_autopilot_bytes.h"

namespace {

template <class Seeds>
void write(const std::filesystem::path& folder, const Seeds& seeds) {
  std::filesystem::create_directories(folder);
  for (const auto& seed : seeds) {
    std::ofstream(folder / seed.name, std::ios::binary) << seed.bytes;
  }
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 2) {
    std::fprintf(stderr, "make_seeds FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder(arguments[1]);
  write(folder / "live", vinerow::fuzz::live_seeds());
  write(folder / "autopilot", vinerow::fuzz::autopilot_seeds());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "make_seeds: %s\n", error.what());
  return 2;
}
