#include "engine/io/cloud_output.h"

#include <fmt/format.h>

#include "engine/core/error.h"

namespace vinerow::io {

CloudOutput::CloudOutput(const std::filesystem::path& file)
    : file_(file), stream_(file, std::ios::binary | std::ios::trunc) {
  if (!stream_) fail("cannot be written");
}

void CloudOutput::flush() {
  stream_.write(pending_.data(), static_cast<std::streamsize>(pending_.size()));
  pending_.clear();
  if (!stream_) fail("cannot be written");
}

void CloudOutput::overwrite_text(std::uint64_t at, std::string_view bytes) {
  stream_.seekp(static_cast<std::streamoff>(at));
  stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void CloudOutput::close() {
  stream_.close();
  if (!stream_) fail("cannot be written");
}

void CloudOutput::check_finite(const CloudPoint& point) const {
  if (!point.position.allFinite()) fail("cannot hold a point that is not finite");
}

void CloudOutput::fail(const std::string& sentence) const {
  throw ConfigError(fmt::format("point cloud '{}' {}", file_.string(), sentence));
}

}  // namespace vinerow::io
