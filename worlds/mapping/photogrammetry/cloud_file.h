#pragma once
/// Writer of a world's point cloud.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/io/clouds/point_cloud_writer.h"
#include "engine/io/geo/local_to_crs.h"
#include "worlds/mapping/photogrammetry/sampled_point.h"

namespace vinerow::mapping {

struct CloudFileOptions {
  std::string crs;             ///< "EPSG:25832", or "": coordinates of W
  bool truth_classes = false;  ///< points carry their true classes
};

/// An unfinished file is removed.
class CloudFile {
 public:
  /// @param near_W  any point near the cloud
  /// @throws ConfigError as create_point_cloud() and LocalToCrs
  CloudFile(const std::filesystem::path& file, const CloudFileOptions& options,
            const GeoOrigin& origin, const Eigen::Vector3d& near_W);

  ~CloudFile();
  CloudFile(const CloudFile&) = delete;
  CloudFile& operator=(const CloudFile&) = delete;

  /// @throws ConfigError as PointCloudWriter::write()
  void write(std::span<const SampledPoint> points);
  /// @returns bytes of the file
  std::uint64_t finish();

 private:
  std::filesystem::path file_;
  bool truth_classes_;
  std::unique_ptr<io::LocalToCrs> to_crs_;  ///< null: W
  std::unique_ptr<io::PointCloudWriter> writer_;
  std::vector<io::CloudPoint> block_;
  bool finished_ = false;
};

}  // namespace vinerow::mapping
