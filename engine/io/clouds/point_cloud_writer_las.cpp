#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/io/clouds/cloud_output.h"
#include "engine/io/clouds/las_header.h"
#include "engine/io/clouds/point_cloud_crs.h"
#include "engine/io/clouds/point_cloud_writer.h"

namespace vinerow::io {
namespace {

constexpr std::uint16_t kHeaderBytes = 227;
constexpr std::uint16_t kRecordHeadBytes = 54;
constexpr std::uint64_t kCountAt = 107;   // count, then five counts by return
constexpr std::uint64_t kBoundsAt = 179;  // max x, min x, max y, ...

/// GeoKeyDirectoryTag: version 1.1.0 and two keys, the model and the EPSG code.
using GeoKeys = std::array<std::uint16_t, 12>;
GeoKeys geo_keys(const EpsgCode& crs) {
  const std::uint16_t model = crs.is_geographic ? 2 : 1;
  const std::uint16_t key = crs.is_geographic ? 2048 : 3072;
  return {1, 1, 0, 2, 1024, 0, 1, model, key, 0, 1, crs.code};
}

class LasWriter : public PointCloudWriter {
 public:
  LasWriter(const std::filesystem::path& file, const PointCloudWriterOptions& options)
      : options_(options), output_(file) {
    for (int k = 0; k < 3; ++k) {
      if (!(options.las_scale[k] > 0.0) || !std::isfinite(options.las_scale[k]) ||
          !std::isfinite(options.las_offset[k])) {
        output_.fail(
            fmt::format("cannot have the LAS scale {} and offset {}, must be finite and "
                        "the scale > 0",
                        options.las_scale[k], options.las_offset[k]));
      }
    }
    std::optional<GeoKeys> keys;
    if (!options.crs.empty()) keys = geo_keys(find_epsg_code(options.crs));
    put_header(keys);
    output_.flush();
  }

  void write(std::span<const CloudPoint> points, std::span<const CloudPulse> pulses) override {
    VINEROW_DEMAND(pulses.size() == (options_.has_pulses ? points.size() : 0));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const CloudPoint& point = points[i];
      const CloudPulse pulse = options_.has_pulses ? pulses[i] : CloudPulse{};
      output_.check_finite(point);
      const Eigen::Vector3d stored = put_position(point.position);
      bounds_.extend(stored);
      VINEROW_DEMAND(pulse.return_number >= 1 && pulse.return_number <= by_return_.size());
      const std::uint8_t classification = point.classification.value_or(0);
      if (classification > 31) {
        output_.fail(
            fmt::format("cannot hold the classification {}, LAS 1.2 has 0 to 31", classification));
      }
      output_.put(pulse.intensity);
      // The number of the return, and the least number of returns that it allows.
      output_.put(static_cast<std::uint8_t>(pulse.return_number * 0x09u));
      ++by_return_[pulse.return_number - 1u];
      output_.put(classification);
      output_.put(std::uint8_t{0});  // scan angle
      output_.put(pulse.user_data);
      output_.put(std::uint16_t{0});  // point source
      if (options_.has_pulses) output_.put(pulse.time_s);
      if (options_.has_colour) {
        for (const std::uint8_t c : point.rgb.value_or(std::array<std::uint8_t, 3>{})) {
          output_.put(static_cast<std::uint16_t>(257 * c));
        }
      }
      if (++count_ > std::numeric_limits<std::uint32_t>::max()) {
        output_.fail("cannot hold more points: LAS 1.2 counts them in 32 bits");
      }
      output_.flush_if_long();
    }
    output_.flush();
  }

  void finish() override {
    output_.overwrite(kCountAt, static_cast<std::uint32_t>(count_));
    output_.overwrite(kCountAt + 4, by_return_);
    if (count_ > 0) {
      const Eigen::Vector3d& lower = bounds_.min();
      const Eigen::Vector3d& upper = bounds_.max();
      output_.overwrite(
          kBoundsAt, std::array{upper.x(), lower.x(), upper.y(), lower.y(), upper.z(), lower.z()});
    }
    output_.close();
  }

 private:
  void put_header(const std::optional<GeoKeys>& keys) {
    const int format = (options_.has_colour ? 2 : 0) + (options_.has_pulses ? 1 : 0);
    output_.put_text("LASF");
    output_.put_text("", 4 + 16);  // file source, global encoding, GUID
    output_.put(std::array<std::uint8_t, 2>{1, 2});
    output_.put_text("OTHER", 32);
    output_.put_text("Vinerow", 32);
    output_.put(std::uint32_t{0});  // day and year: not set, so that equal clouds give equal files
    output_.put(kHeaderBytes);
    output_.put(
        static_cast<std::uint32_t>(kHeaderBytes + (keys ? kRecordHeadBytes + sizeof *keys : 0)));
    output_.put(std::uint32_t{keys ? 1u : 0u});
    output_.put(static_cast<std::uint8_t>(format));
    output_.put(static_cast<std::uint16_t>(las_point_bytes(format)));
    output_.put_text("", 6 * 4);  // counts, overwritten at the end
    for (int k = 0; k < 3; ++k) output_.put(options_.las_scale[k]);
    for (int k = 0; k < 3; ++k) output_.put(options_.las_offset[k]);
    output_.put_text("", 6 * 8);  // bounds, overwritten at the end
    if (!keys) return;
    output_.put(std::uint16_t{0});
    output_.put_text("LASF_Projection", 16);
    output_.put(std::uint16_t{34735});
    output_.put(static_cast<std::uint16_t>(sizeof *keys));
    output_.put_text("GeoTIFF GeoKeyDirectoryTag", 32);
    output_.put(*keys);
  }

  /// @returns the position as rounded in the file
  Eigen::Vector3d put_position(const Eigen::Vector3d& position) {
    Eigen::Vector3d stored;
    for (int k = 0; k < 3; ++k) {
      const double steps =
          std::round((position[k] - options_.las_offset[k]) / options_.las_scale[k]);
      if (std::abs(steps) > std::numeric_limits<std::int32_t>::max()) {
        output_.fail(fmt::format("cannot hold {} = {}: 32 bits of scale {} reach from {} by {}",
                                 "xyz"[k], position[k], options_.las_scale[k],
                                 options_.las_offset[k],
                                 options_.las_scale[k] * std::numeric_limits<std::int32_t>::max()));
      }
      const auto integer = static_cast<std::int32_t>(steps);
      output_.put(integer);
      stored[k] = options_.las_scale[k] * integer + options_.las_offset[k];
    }
    return stored;
  }

  const PointCloudWriterOptions options_;
  CloudOutput output_;
  Eigen::AlignedBox3d bounds_;
  std::uint64_t count_ = 0;
  std::array<std::uint32_t, 5> by_return_{};
};

}  // namespace

std::unique_ptr<PointCloudWriter> create_las_cloud(const std::filesystem::path& file,
                                                   const PointCloudWriterOptions& options) {
  return std::make_unique<LasWriter>(file, options);
}

std::unique_ptr<PointCloudWriter> create_point_cloud(const std::filesystem::path& file,
                                                     const PointCloudWriterOptions& options) {
  const std::string extension = file.extension().string();
  if (extension == ".ply") return create_ply_cloud(file, options);
  if (extension == ".las") return create_las_cloud(file, options);
  if (extension == ".xyz" || extension == ".txt") return create_xyz_cloud(file, options);
  throw ConfigError(fmt::format(
      "point cloud '{}' cannot be written as '{}', must be one of: .ply, .las, .xyz, .txt",
      file.string(), extension));
}

}  // namespace vinerow::io
