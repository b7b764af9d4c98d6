#include <fmt/format.h>

#include "engine/io/clouds/cloud_output.h"
#include "engine/io/clouds/point_cloud_writer.h"

namespace vinerow::io {
namespace {

class XyzWriter : public PointCloudWriter {
 public:
  XyzWriter(const std::filesystem::path& file, const PointCloudWriterOptions& options)
      : output_(file), options_(options) {
    output_.put_text(fmt::format("x y z{}{}\n", options.has_colour ? " red green blue" : "",
                                 options.has_classification ? " classification" : ""));
  }

  void write(std::span<const CloudPoint> points, std::span<const CloudPulse> /*pulses*/) override {
    for (const CloudPoint& point : points) {
      output_.check_finite(point);
      const Eigen::Vector3d& p = point.position;
      output_.put_text(fmt::format("{} {} {}", p.x(), p.y(), p.z()));
      if (options_.has_colour) {
        const std::array<std::uint8_t, 3> rgb = point.rgb.value_or(std::array<std::uint8_t, 3>{});
        output_.put_text(fmt::format(" {} {} {}", rgb[0], rgb[1], rgb[2]));
      }
      if (options_.has_classification) {
        output_.put_text(fmt::format(" {}", point.classification.value_or(0)));
      }
      output_.put_text("\n");
      output_.flush_if_long();
    }
    output_.flush();
  }

  void finish() override {
    output_.flush();
    output_.close();
  }

 private:
  CloudOutput output_;
  const PointCloudWriterOptions options_;
};

}  // namespace

std::unique_ptr<PointCloudWriter> create_xyz_cloud(const std::filesystem::path& file,
                                                   const PointCloudWriterOptions& options) {
  return std::make_unique<XyzWriter>(file, options);
}

}  // namespace vinerow::io
