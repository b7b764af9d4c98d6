#include <fmt/format.h>

#include "engine/io/clouds/cloud_output.h"
#include "engine/io/clouds/point_cloud_writer.h"

namespace vinerow::io {
namespace {

/// The header is written at the start, and again with the final count at the end. A comment before
/// the count fills the unused digits, so that the length is constant.
std::string header_of(std::uint64_t count, const PointCloudWriterOptions& options) {
  constexpr std::size_t kDigits = 20;  // of 2^64 - 1
  const std::string number = fmt::format("{}", count);
  std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment written by Vinerow {}\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\n",
      std::string(kDigits - number.size() + 1, '-'), number);
  if (options.has_colour) {
    header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  }
  if (options.has_classification) header += "property uchar classification\n";
  return header + "end_header\n";
}

class PlyWriter : public PointCloudWriter {
 public:
  PlyWriter(const std::filesystem::path& file, const PointCloudWriterOptions& options)
      : output_(file), options_(options) {
    output_.put_text(header_of(0, options_));
    output_.flush();
  }

  void write(std::span<const CloudPoint> points, std::span<const CloudPulse> /*pulses*/) override {
    for (const CloudPoint& point : points) {
      output_.check_finite(point);
      for (int k = 0; k < 3; ++k) output_.put(point.position[k]);
      if (options_.has_colour) output_.put(point.rgb.value_or(std::array<std::uint8_t, 3>{}));
      if (options_.has_classification) output_.put(point.classification.value_or(0));
      ++count_;
      output_.flush_if_long();
    }
    output_.flush();
  }

  void finish() override {
    output_.overwrite_text(0, header_of(count_, options_));
    output_.close();
  }

 private:
  CloudOutput output_;
  const PointCloudWriterOptions options_;
  std::uint64_t count_ = 0;
};

}  // namespace

std::unique_ptr<PointCloudWriter> create_ply_cloud(const std::filesystem::path& file,
                                                   const PointCloudWriterOptions& options) {
  return std::make_unique<PlyWriter>(file, options);
}

}  // namespace vinerow::io
