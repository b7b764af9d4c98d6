#pragma once
/// Block-wise writers of point clouds: PLY binary, LAS 1.2, XYZ.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "engine/io/clouds/point_cloud.h"

namespace vinerow::io {

struct PointCloudWriterOptions {
  bool has_colour = false;          ///< points without colour become black
  bool has_classification = false;  ///< points without one become 0; LAS always stores it, below 32
  bool has_pulses = false;          ///< of LAS: points have a time
  std::string crs;                  ///< LAS: "EPSG:25832" or ""; PLY and XYZ do not store it
  Eigen::Vector3d las_offset = {0, 0, 0};          ///< near the cloud, in its unit
  Eigen::Vector3d las_scale = {1e-3, 1e-3, 1e-3};  ///< > 0: positions are rounded to it
};

/// What LAS also keeps of a point of a laser scanner.
struct CloudPulse {
  std::uint16_t intensity = 0;
  std::uint8_t return_number = 1;  ///< 1 to 5
  std::uint8_t user_data = 0;
  double time_s = 0.0;
};

/// Writer of one file. Memory does not grow with the number of points.
class PointCloudWriter {
 public:
  virtual ~PointCloudWriter() = default;
  PointCloudWriter(const PointCloudWriter&) = delete;
  PointCloudWriter& operator=(const PointCloudWriter&) = delete;

  /// @throws ConfigError naming the file: it cannot be written, or a position is not finite; for
  /// LAS also if a scaled position does not fit into 32 bits or a classification exceeds 31
  void write(std::span<const CloudPoint> points) { write(points, {}); }
  /// @param pulses  of the points, if the options have has_pulses; only LAS keeps them
  virtual void write(std::span<const CloudPoint> points, std::span<const CloudPulse> pulses) = 0;
  /// Completes the file: counts and bounds in its header are valid only after this call. @throws
  /// ConfigError
  virtual void finish() = 0;

 protected:
  PointCloudWriter() = default;
};

/// Little-endian PLY 1.0: double x y z, uchar red green blue, uchar classification.
std::unique_ptr<PointCloudWriter> create_ply_cloud(const std::filesystem::path& file,
                                                   const PointCloudWriterOptions& options = {});

/// LAS 1.2, point format 0, with colour 2, with pulses 1 and 3, the EPSG code as GeoTIFF keys.
/// Colours are written in 16 bits as 257 times the byte.
/// @throws ConfigError also if `crs` is neither "" nor the EPSG code of a geographic or projected
/// system
std::unique_ptr<PointCloudWriter> create_las_cloud(const std::filesystem::path& file,
                                                   const PointCloudWriterOptions& options = {});

/// A line of column names, then one line per point, separated by blanks. Numbers are read back bit
/// for bit.
std::unique_ptr<PointCloudWriter> create_xyz_cloud(const std::filesystem::path& file,
                                                   const PointCloudWriterOptions& options = {});

/// Creates one of the above by the extension: .ply, .las, .xyz or .txt. @throws ConfigError for
/// others
std::unique_ptr<PointCloudWriter> create_point_cloud(const std::filesystem::path& file,
                                                     const PointCloudWriterOptions& options = {});

}  // namespace vinerow::io
