#pragma once
/// A small vineyard, a cloud of it and the map that the command makes of the cloud.

#include <string>
#include <vector>

#include "tests/scenarios/command.h"

namespace vinerow::test {

/// Four rows of 24 m on a hillside.
inline const char* const kSmallVineyard =
    "world:\n"
    "  type: vineyard\n"
    "  row_count: 4\n"
    "  row_length_m: 24\n"
    "  leaf_cards_per_m: 10\n"
    "  missing_vine_share: 0.04\n";

/// @returns a scenario file in the folder: the world, and what else is given
inline std::string small_scenario(const ScratchFolder& folder, const std::string& name,
                                  const std::string& rest) {
  return folder.file(name + ".yaml", "vinerow: 1\nname: " + name + "\n" + kSmallVineyard + rest);
}

/// Samples the world evenly, 600 points a square metre with 1 cm of noise. @returns the cloud
inline std::string small_cloud(const ScratchFolder& folder) {
  const std::string cloud = (folder.path() / "parcel.las").string();
  const auto result = run_vinerow(
      "cloud " +
      small_scenario(
          folder, "world",
          "duration_s: 1\nvehicles: {rover: {type: diff_drive_rover, spawn: {alley: 0}}}\n") +
      " --uniform 600 --noise 0.01 --out " + cloud);
  if (result.status != 0) throw std::runtime_error(result.output);
  return cloud;
}

}  // namespace vinerow::test
