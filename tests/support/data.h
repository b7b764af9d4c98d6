#pragma once
/// Where a test finds data made by others, which the repository does not hold.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include "tests/support/paths.h"

namespace vinerow::test {

/// Folder with outside data: $VINEROW_DATA, or ../shared/data beside the project.
inline std::filesystem::path outside_data_folder() {
  if (const char* folder = std::getenv("VINEROW_DATA")) return folder;
  return std::filesystem::path(VINEROW_SOURCE_DIR) / ".." / "shared" / "data";
}

}  // namespace vinerow::test

/// Skips the running test, by name, where the outside file or folder is absent; else sets
/// `variable`.
#define VINEROW_OUTSIDE_DATA(variable, relative)                                              \
  const std::filesystem::path variable = ::vinerow::test::outside_data_folder() / (relative); \
  if (!std::filesystem::exists(variable)) GTEST_SKIP() << "outside data absent: " << (relative)
