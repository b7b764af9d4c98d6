#pragma once
/// Writes point clouds a block at a time: PLY binary, LAS 1.2, XYZ.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "engine/io/clouds/point_cloud.h"

namespace vinerow::io {

struct PointCloudWriterOptions {
  bool has_colour = false;          ///< points without colour become black
  bool has_classification = false;  ///< points without one become 0; LAS has it always, below 32
  std::string crs;                  ///< LAS: "EPSG:25832" or ""; PLY and XYZ cannot tell it
  Eigen::Vector3d las_offset = {0, 0, 0};          ///< near the cloud, in its unit
  Eigen::Vector3d las_scale = {1e-3, 1e-3, 1e-3};  ///< > 0: positions are rounded to it
};

/// Memory does not grow with what is written.
class PointCloudWriter {
 public:
  virtual ~PointCloudWriter() = default;
  PointCloudWriter(const PointCloudWriter&) = delete;
  PointCloudWriter& operator=(const PointCloudWriter&) = delete;

  /// @throws ConfigError naming the file: it cannot be written, a position is not finite, LAS: a
  /// position does not fit 32 bits of its scale, a classification above 31
  virtual void write(std::span<const CloudPoint> points) = 0;
  /// Ends the file: its counts and bounds are right only after this. @throws ConfigError
  virtual void finish() = 0;

 protected:
  PointCloudWriter() = default;
};

/// Little-endian PLY 1.0: double x y z, uchar red green blue, uchar classification.
std::unique_ptr<PointCloudWriter> create_ply_cloud(const std::filesystem::path& file,
                                                   const PointCloudWriterOptions& options = {});

/// LAS 1.2, point format 0 or (with colour) 2, the EPSG code as GeoTIFF keys. Colours are written
/// in 16 bits as 257 times the byte.
/// @throws ConfigError also where `crs` is neither "" nor the EPSG code of a geographic or
/// projected system
std::unique_ptr<PointCloudWriter> create_las_cloud(const std::filesystem::path& file,
                                                   const PointCloudWriterOptions& options = {});

/// A line of names, then one line a point, blanks between; numbers read back to the same bits.
std::unique_ptr<PointCloudWriter> create_xyz_cloud(const std::filesystem::path& file,
                                                   const PointCloudWriterOptions& options = {});

/// One of the above by the extension: .ply, .las, .xyz or .txt. @throws ConfigError for others
std::unique_ptr<PointCloudWriter> create_point_cloud(const std::filesystem::path& file,
                                                     const PointCloudWriterOptions& options = {});

}  // namespace vinerow::io
