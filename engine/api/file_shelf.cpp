#include "engine/api/file_shelf.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace vinerow {
namespace {

std::string mark_one(const std::filesystem::path& file) {
  std::error_code failed;
  const std::uintmax_t size = std::filesystem::file_size(file, failed);
  const auto written = std::filesystem::last_write_time(file, failed);
  if (failed) return fmt::format("{} ?\n", file.string());
  return fmt::format("{} {} {}\n", file.string(), size, written.time_since_epoch().count());
}

}  // namespace

std::string file_mark(const std::filesystem::path& path) {
  std::error_code failed;
  if (!std::filesystem::is_directory(path, failed)) return mark_one(path);
  std::vector<std::string> marks;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path, failed)) {
    if (entry.is_regular_file(failed)) marks.push_back(mark_one(entry.path()));
  }
  // A folder lists its entries in the order of the file system.
  std::sort(marks.begin(), marks.end());
  return fmt::format("{}\n{}", path.string(), fmt::join(marks, ""));
}

}  // namespace vinerow
