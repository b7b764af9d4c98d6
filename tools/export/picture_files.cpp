#include "tools/export/picture_files.h"

#include <fmt/format.h>

#include <string_view>

#include "engine/core/whole_file.h"
#include "engine/io/files/csv.h"
#include "engine/io/files/output_folder.h"
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

PictureFiles::PictureFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

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
  const std::string name = fmt::format("{:015d}{}", stamp_ns, ending);
  const std::filesystem::path file = folder_ / name;
  if (count_ == 0) io::make_folder_of(file);
  write_whole_file(file, bytes);
  list_ += fmt::format("{},{},{},{},{}\n", static_cast<double>(stamp_ns) / 1e9,
                       static_cast<double>(logged_ns) / 1e9, io::csv_text(frame),
                       io::csv_text(format), io::csv_text((folder_.filename() / name).string()));
  ++count_;
  return true;
}

int PictureFiles::finish() {
  const std::filesystem::path file = folder_.string() + ".csv";
  io::make_folder_of(file);
  write_whole_file(file, list_);
  return count_;
}

}  // namespace vinerow::tools
