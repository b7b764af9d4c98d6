/// make_live_seeds FOLDER: writes the seeds of the fuzz target of live runs into FOLDER/live.

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include "tests/fuzz/live_seeds.h"

int main(int count, char** arguments) try {
  if (count != 2) {
    std::fprintf(stderr, "make_live_seeds FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = std::filesystem::path(arguments[1]) / "live";
  std::filesystem::create_directories(folder);
  for (const vinerow::fuzz::LiveSeed& seed : vinerow::fuzz::live_seeds()) {
    std::ofstream(folder / seed.name, std::ios::binary) << seed.bytes;
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "make_live_seeds: %s\n", error.what());
  return 2;
}
