#include "engine/io/clouds/cloud_output.h"

#include <fmt/format.h>

#include "engine/core/error.h"

namespace vinerow::io {

CloudOutput::CloudOutput(const std::filesystem::path& file)
    : file_(file), out_(file, "point cloud") {}

void CloudOutput::flush() {
  out_.write(pending_);
  pending_.clear();
}

void CloudOutput::overwrite_text(std::uint64_t at, std::string_view bytes) {
  std::fseek(out_.stream(), static_cast<long>(at), SEEK_SET);
  out_.write(bytes);
}

void CloudOutput::close() {
  out_.finish();
}

void CloudOutput::check_finite(const CloudPoint& point) const {
  if (!point.position.allFinite()) fail("cannot hold a point that is not finite");
}

void CloudOutput::fail(const std::string& sentence) const {
  throw ConfigError(fmt::format("point cloud '{}' {}", file_.string(), sentence));
}

}  // namespace vinerow::io
