#pragma once
/// Block-wise reader of point cloud files: PLY, LAS 1.2 to 1.4, PCD, XYZ and CSV.
///
/// Positions are the file's own numbers as double: metres in a local frame, or coordinates in the
/// CRS that the file names (PointCloudInfo::crs). CloudFrame (point_cloud_crs.h) transforms them to
/// W. Points keep the file's order; duplicates are kept.
///
/// Memory: a reader holds at most kPointCloudMemory bytes for files of any length, and read() does
/// not allocate.

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace vinerow::io {

class BlockFile;

inline constexpr std::size_t kPointCloudMemory = 4 << 20;  ///< bytes per open reader, maximum

/// One point of a file.
struct CloudPoint {
  Eigen::Vector3d position = {0, 0, 0};            ///< finite; in the file's frame and unit
  std::optional<std::array<std::uint8_t, 3>> rgb;  ///< sRGB
  std::optional<std::uint8_t> classification;      ///< as in LAS: 2 ground, 3 to 5 vegetation
};

/// Metadata of a point cloud from its header. The bounds are the header's and not checked.
struct PointCloudInfo {
  std::string format;                         ///< "LAS 1.4", "PLY"
  std::optional<std::uint64_t> record_count;  ///< from the header, with skipped records
  std::optional<Eigen::AlignedBox3d> bounds;  ///< in the file's frame and unit
  bool has_colour = false;
  bool has_classification = false;
  std::string crs;  ///< "EPSG:25832", "EPSG:25832+7837" (with heights), WKT, or "" if unknown
};

/// Counts of the records read so far.
struct PointCloudTally {
  std::uint64_t given = 0;
  std::uint64_t not_finite = 0;  ///< skipped: a coordinate is NaN or infinite
  std::uint64_t withheld = 0;    ///< skipped: LAS marks them as deleted
};

/// Reader of an open file; each point is read once, in file order.
class PointCloudReader {
 public:
  virtual ~PointCloudReader() = default;
  PointCloudReader(const PointCloudReader&) = delete;
  PointCloudReader& operator=(const PointCloudReader&) = delete;

  const PointCloudInfo& info() const { return info_; }
  const PointCloudTally& tally() const { return tally_; }

  /// Fills `block` from its front. @returns the number of points, less than block.size() only at
  /// the end of the file. @throws ConfigError naming the file: truncated, a text that is not a
  /// number, or more or fewer points than the header counts (with both numbers)
  std::size_t read(std::span<CloudPoint> block);

 protected:
  enum class Next { kPoint, kWithheld, kEnd };
  PointCloudReader() = default;
  /// Reads the next record, finite or not. Sets every field of `point` if it returns kPoint.
  virtual Next next(CloudPoint& point) = 0;
  PointCloudInfo info_;

 private:
  PointCloudTally tally_;
  bool ended_ = false;
};

/// Opens a file. Its first bytes or its extension (.xyz .txt .csv .asc .pts) select the format.
/// @throws ConfigError naming the file: missing, empty, unknown format, invalid header, data
/// shorter or longer than the header states, or compressed (LAZ, binary_compressed PCD; the message
/// says how to decompress it)
std::unique_ptr<PointCloudReader> open_point_cloud(const std::filesystem::path& file);
/// The same for an open file at its first byte.
std::unique_ptr<PointCloudReader> open_point_cloud(BlockFile bytes);

}  // namespace vinerow::io
