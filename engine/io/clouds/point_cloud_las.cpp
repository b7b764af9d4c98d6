#include "engine/io/clouds/point_cloud_las.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/io/clouds/las_header.h"
#include "engine/io/clouds/point_cloud_scalar.h"

namespace vinerow::io {
namespace {

/// Right shift of a file's colours to bytes: 8, or 0 if all samples are at most 255.
int colour_shift(BlockFile& file, const LasHeader& header, std::size_t colour_at) {
  constexpr std::uint64_t kSamples = 1024;
  const std::uint64_t step = std::max<std::uint64_t>(1, header.point_count / kSamples);
  for (std::uint64_t k = 0; k < header.point_count; k += step) {
    file.seek(header.points_at + k * header.record_bytes + colour_at);
    const std::uint8_t* rgb = file.take(6);
    if (rgb == nullptr) break;
    for (int c = 0; c < 3; ++c) {
      if (load<std::uint16_t>(rgb + 2 * c) > 255) return 8;
    }
  }
  return 0;
}

class LasReader : public PointCloudReader {
 public:
  explicit LasReader(BlockFile file) : file_(std::move(file)), header_(read_las_header(file_)) {
    colour_at_ = las_colour_at(header_.point_format);
    if (colour_at_) shift_ = colour_shift(file_, header_, *colour_at_);
    file_.seek(header_.points_at);
    info_.format = fmt::format("LAS 1.{}", header_.minor);
    info_.record_count = header_.point_count;
    info_.bounds = header_.bounds;
    info_.has_colour = colour_at_.has_value();
    info_.has_classification = true;
    info_.crs = header_.crs;
  }

 protected:
  Next next(CloudPoint& point) override {
    if (at_ == header_.point_count) return Next::kEnd;
    const std::uint8_t* record = file_.take(header_.record_bytes);
    if (record == nullptr) {  // the file was truncated after it was opened
      file_.fail(fmt::format("is cut off: its header counts {} points, it holds {}",
                             header_.point_count, at_));
    }
    ++at_;
    // Formats 0 to 5 store the flags in the classification byte, 6 to 10 in the byte before it.
    const bool is_wide = header_.point_format >= 6;
    if (is_wide ? (record[15] & 0x04) != 0 : (record[15] & 0x80) != 0) return Next::kWithheld;
    point.classification = is_wide ? record[16] : static_cast<std::uint8_t>(record[15] & 0x1f);
    for (int k = 0; k < 3; ++k) {
      point.position[k] = header_.scale[k] * load<std::int32_t>(record + 4 * k) + header_.offset[k];
    }
    point.rgb.reset();
    if (colour_at_) {
      const auto channel = [&](int c) {
        const int value = load<std::uint16_t>(record + *colour_at_ + 2 * c) >> shift_;
        return static_cast<std::uint8_t>(std::min(value, 255));
      };
      point.rgb = {{channel(0), channel(1), channel(2)}};
    }
    return Next::kPoint;
  }

 private:
  BlockFile file_;
  LasHeader header_;
  std::optional<std::size_t> colour_at_;
  int shift_ = 0;
  std::uint64_t at_ = 0;
};

}  // namespace

std::unique_ptr<PointCloudReader> open_las(BlockFile file) {
  return std::make_unique<LasReader>(std::move(file));
}

}  // namespace vinerow::io
