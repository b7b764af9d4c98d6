#pragma once
/// Compressed pictures of a topic as files.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace vinerow::tools {

/// Whether messages of this type are compressed pictures.
bool is_picture_type(const std::string& ros_type);

/// Writes the pictures of a topic into a folder, each under its stamp in nanoseconds, and a list of
/// them beside the folder.
class PictureFiles {
 public:
  /// @param folder  of the pictures; <folder>.csv is the list
  explicit PictureFiles(std::filesystem::path folder);

  /// @param stamp_ns  for the file's name  @param message  a CompressedImage
  /// @returns false, and writes nothing, if it is none or neither PNG nor JPEG
  /// @throws ConfigError if the file cannot be written
  bool add(std::int64_t stamp_ns, std::int64_t logged_ns, std::span<const std::uint8_t> message);
  /// Writes the list: time_s, logged_s, frame_id, format, file. @returns number of pictures
  int finish();

 private:
  std::filesystem::path folder_;
  std::string list_ = "time_s,logged_s,frame_id,format,file\n";
  int count_ = 0;
};

}  // namespace vinerow::tools
