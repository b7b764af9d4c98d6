#pragma once
/// Compressed pictures of a topic as files.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "tools/export/listed_files.h"

namespace vinerow::tools {

/// Whether messages of this type are compressed pictures.
bool is_picture_type(const std::string& ros_type);

/// Writes the pictures of a topic into a folder; the list has frame_id and format.
class PictureFiles {
 public:
  /// @param folder  as for ListedFiles
  explicit PictureFiles(std::filesystem::path folder);

  /// @param stamp_ns  for the file's name  @param message  a CompressedImage
  /// @returns false, and writes nothing, if it is none or neither PNG nor JPEG
  /// @throws ConfigError if the file cannot be written
  bool add(std::int64_t stamp_ns, std::int64_t logged_ns, std::span<const std::uint8_t> message);
  /// Writes the list. @returns number of pictures
  int finish() { return files_.finish(); }

 private:
  ListedFiles files_;
};

}  // namespace vinerow::tools
