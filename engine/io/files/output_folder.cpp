#include "engine/io/files/output_folder.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

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

ResultFolder::ResultFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::error_code failed;
  is_new_ = !std::filesystem::exists(folder_, failed);
  make_folder(folder_);
}

ResultFolder::~ResultFolder() {
  std::error_code failed;
  if (is_new_) std::filesystem::remove(folder_, failed);  // fails unless it is empty
}

void make_folder_of(const std::filesystem::path& file) {
  if (!file.parent_path().empty()) make_folder(file.parent_path());
}

}  // namespace vinerow::io
