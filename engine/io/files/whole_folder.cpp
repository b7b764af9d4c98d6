#include "engine/io/files/whole_folder.h"

#include <fmt/format.h>

#include <system_error>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"

namespace vinerow::io {

void check_new_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  const bool exists = std::filesystem::exists(std::filesystem::symlink_status(folder, failed));
  if (exists && !std::filesystem::is_directory(folder, failed)) {
    throw ConfigError(fmt::format(
        "'{}' is not a folder: remove it, or choose another folder with --out", folder.string()));
  }
  if (exists && !std::filesystem::is_empty(folder, failed)) {
    throw ConfigError(
        fmt::format("'{}' exists and is not empty: remove it, or choose another "
                    "folder with --out",
                    folder.string()));
  }
}

WholeFolder::WholeFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  if (!folder_.has_filename()) folder_ = folder_.parent_path();  // "x/" is "x"
  check_new_folder(folder_);
  std::error_code failed;
  unfinished_ = folder_.string() + ".unfinished";
  std::filesystem::remove_all(unfinished_, failed);
  make_folder(unfinished_);
}

WholeFolder::~WholeFolder() {
  std::error_code failed;
  if (!unfinished_.empty()) std::filesystem::remove_all(unfinished_, failed);
}

void WholeFolder::finish() {
  std::error_code failed;
  std::filesystem::remove(folder_, failed);  // an empty folder
  std::filesystem::rename(unfinished_, folder_, failed);
  if (failed) throw_cannot_write(fmt::format("'{}'", folder_.string()), failed.value());
  unfinished_.clear();
}

}  // namespace vinerow::io
