#pragma once
/// Messages of a topic as files, with a list of them.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vinerow::tools {

/// A folder of files, each named after its stamp in nanoseconds, and beside the folder a list.
class ListedFiles {
 public:
  /// @param folder  of the files; <folder>.csv is the list
  /// @param columns  of the list, between logged_s and file
  ListedFiles(std::filesystem::path folder, const std::string& columns);

  /// @param cells  one for each of the columns  @param ending  ".png"
  /// @throws ConfigError, WriteError if the file cannot be written
  void add(std::int64_t stamp_ns, std::int64_t logged_ns, const std::vector<std::string>& cells,
           std::string_view bytes, std::string_view ending);
  /// Writes the list. @returns number of files
  int finish();

 private:
  std::filesystem::path folder_;
  std::string list_;
  int count_ = 0;
};

}  // namespace vinerow::tools
