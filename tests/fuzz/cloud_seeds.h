#pragma once
/// Small point clouds to start fuzzing from: what our writers make, and files by hand with what is
/// rare in the wild.

#include <filesystem>
#include <string>
#include <vector>

#include "tests/fuzz/read_cloud_bytes.h"

namespace vinerow::fuzz {

struct CloudSeed {
  std::string name;  ///< with the extension of its kind
  CloudKind kind = CloudKind::kAny;
  std::string bytes;
};

/// Each below 2 kB. @param folder  for the writers' files, which are removed
std::vector<CloudSeed> cloud_seeds(const std::filesystem::path& folder);

}  // namespace vinerow::fuzz
