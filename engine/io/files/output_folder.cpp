#include "engine/io/files/output_folder.h"

#include <fmt/format.h>

#include <system_error>

#include "engine/core/error.h"

namespace vinerow::io {

void make_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) {
    throw ConfigError(
        fmt::format("folder '{}' cannot be created: {}", folder.string(), failed.message()));
  }
}

void make_folder_of(const std::filesystem::path& file) {
  if (!file.parent_path().empty()) make_folder(file.parent_path());
}

}  // namespace vinerow::io
