#include "worlds/mapping/photogrammetry/cloud_file.h"

#include <cmath>
#include <system_error>

#include "engine/io/clouds/point_cloud_crs.h"

namespace vinerow::mapping {
namespace {

/// Points this near to each other go to a CRS by one straight map, see LocalToCrs::Nearby.
constexpr double kReach_m = 20.0;

}  // namespace

CloudFile::CloudFile(const std::filesystem::path& file, const CloudFileOptions& options,
                     const GeoOrigin& origin, const Eigen::Vector3d& near_W)
    : file_(file), truth_classes_(options.truth_classes) {
  io::PointCloudWriterOptions writer;
  writer.has_colour = true;
  writer.has_classification = options.truth_classes;
  writer.crs = options.crs;
  Eigen::Vector3d near = near_W;
  if (!options.crs.empty()) {
    to_crs_ = std::make_unique<io::LocalToCrs>(options.crs, origin);
    near = to_crs_->from_local(near_W);
    if (io::find_epsg_code(options.crs).is_geographic) {
      writer.las_scale = {1e-9, 1e-9, 1e-3};  // a tenth of a millimetre
    }
  }
  for (int k = 0; k < 3; ++k) writer.las_offset[k] = std::round(near[k]);
  writer_ = io::create_point_cloud(file, writer);
}

CloudFile::~CloudFile() {
  if (finished_) return;
  writer_.reset();
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

void CloudFile::write(std::span<const SampledPoint> points) {
  block_.resize(points.size());
  io::LocalToCrs::Nearby nearby;
  nearby.centre_W.setConstant(std::nan(""));
  for (std::size_t k = 0; k < points.size(); ++k) {
    const SampledPoint& point = points[k];
    io::CloudPoint& out = block_[k];
    out.position = point.p_W;
    if (to_crs_) {
      if (!((point.p_W - nearby.centre_W).norm() <= kReach_m)) nearby = to_crs_->near(point.p_W);
      out.position = nearby(point.p_W);
    }
    out.rgb = point.rgb;
    if (truth_classes_) out.classification = static_cast<std::uint8_t>(point.truth);
  }
  writer_->write(block_);
}

std::uint64_t CloudFile::finish() {
  writer_->finish();
  finished_ = true;
  return std::filesystem::file_size(file_);
}

}  // namespace vinerow::mapping
