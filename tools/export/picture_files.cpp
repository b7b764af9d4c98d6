#include "tools/export/picture_files.h"

#include <string_view>

#include "engine/record/cdr.h"

namespace vinerow::tools {
namespace {

/// By the first bytes: what a message says of its format is not checked by those who write it.
const char* ending_of(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return ".png";
  if (bytes.starts_with("\xff\xd8\xff")) return ".jpg";
  return nullptr;
}

}  // namespace

bool is_picture_type(const std::string& ros_type) {
  return ros_type == "sensor_msgs/msg/CompressedImage";
}

PictureFiles::PictureFiles(std::filesystem::path folder)
    : files_(std::move(folder), "frame_id,format") {}

bool PictureFiles::add(std::int64_t stamp_ns, std::int64_t logged_ns,
                       std::span<const std::uint8_t> message) {
  record::CdrReader in(message);
  in.read<std::int32_t>();
  in.read<std::uint32_t>();
  const std::string frame(in.read_text()), format(in.read_text());
  std::string bytes(in.read_count(1), '\0');
  in.read_octets(reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size());
  const char* const ending = ending_of(bytes);
  if (!in.ok() || ending == nullptr) return false;
  files_.add(stamp_ns, logged_ns, {frame, format}, bytes, ending);
  return true;
}

}  // namespace vinerow::tools
