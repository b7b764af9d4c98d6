/// make_cloud_seeds FOLDER: writes the seeds of the fuzz targets into FOLDER/{las,ply,pcd,xyz,any}.

#include <cstdio>
#include <exception>
#include <fstream>
#include <map>

#include "tests/fuzz/cloud_seeds.h"

int main(int count, char** arguments) try {
  if (count != 2) {
    std::fprintf(stderr, "make_cloud_seeds FOLDER\n");
    return 2;
  }
  using vinerow::fuzz::CloudKind;
  const std::map<CloudKind, const char*> folders = {{CloudKind::kLas, "las"},
                                                    {CloudKind::kPly, "ply"},
                                                    {CloudKind::kPcd, "pcd"},
                                                    {CloudKind::kXyz, "xyz"}};
  const std::filesystem::path folder = arguments[1];
  std::filesystem::create_directories(folder / "any");
  for (const auto& [kind, name] : folders) std::filesystem::create_directories(folder / name);
  for (const vinerow::fuzz::CloudSeed& seed : vinerow::fuzz::cloud_seeds(folder)) {
    for (const std::filesystem::path& into : {folder / folders.at(seed.kind), folder / "any"}) {
      std::ofstream(into / seed.name, std::ios::binary) << seed.bytes;
    }
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "make_cloud_seeds: %s\n", error.what());
  return 2;
}
