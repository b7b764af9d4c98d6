#pragma once
/// Point clouds from files, a block of points at a time: PLY, LAS 1.2 to 1.4, PCD, XYZ and CSV.
///
/// Positions are the file's own numbers as double: metres of a local frame, or coordinates of the
/// CRS that the file names (PointCloudInfo::crs); point_cloud_frame.h brings them to W. Points are
/// given in file order, equal ones as often as the file has them.
///
/// Memory: a reader holds at most kPointCloudMemory bytes, however long the file is, and read()
/// takes none from the heap.

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

inline constexpr std::size_t kPointCloudMemory = 4 << 20;  ///< bytes of an open reader, at most

/// One point as a file tells it.
struct CloudPoint {
  Eigen::Vector3d position = {0, 0, 0};            ///< finite; in the file's frame and unit
  std::optional<std::array<std::uint8_t, 3>> rgb;  ///< as on a screen (sRGB)
  std::optional<std::uint8_t> classification;      ///< as in LAS: 2 ground, 3 to 5 vegetation
};

/// What a file says of itself before its points. Bounds are the file's word and not checked.
struct PointCloudInfo {
  std::string format;                         ///< "LAS 1.4", "PLY"
  std::optional<std::uint64_t> record_count;  ///< of the header, with what read() leaves out
  std::optional<Eigen::AlignedBox3d> bounds;  ///< in the file's frame and unit
  bool has_colour = false;
  bool has_classification = false;
  std::string crs;  ///< "EPSG:25832", "EPSG:25832+7837" (with heights), WKT, or "" where untold
};

/// What read() has met so far.
struct PointCloudTally {
  std::uint64_t given = 0;
  std::uint64_t not_finite = 0;  ///< left out: a coordinate is NaN or infinite
  std::uint64_t withheld = 0;    ///< left out: LAS marks them as deleted
};

/// An open file, read once from its first point to its last.
class PointCloudReader {
 public:
  virtual ~PointCloudReader() = default;
  PointCloudReader(const PointCloudReader&) = delete;
  PointCloudReader& operator=(const PointCloudReader&) = delete;

  const PointCloudInfo& info() const { return info_; }
  const PointCloudTally& tally() const { return tally_; }

  /// Fills `block` from its front. @returns how many points; fewer than block.size() at the end
  /// alone. @throws ConfigError naming the file: cut off, a text that is no number, more or fewer
  /// points than its header counts (both numbers are told)
  std::size_t read(std::span<CloudPoint> block);

 protected:
  enum class Next { kPoint, kWithheld, kEnd };
  PointCloudReader() = default;
  /// The next record, finite or not. Sets every field of `point` where it gives kPoint.
  virtual Next next(CloudPoint& point) = 0;
  PointCloudInfo info_;

 private:
  PointCloudTally tally_;
  bool ended_ = false;
};

/// The reader for the file: by its first bytes, or by its extension (.xyz .txt .csv .asc .pts).
/// @throws ConfigError naming the file: missing, empty, of an unknown format, a header that cannot
/// be, data shorter or longer than the header counts, compressed (LAZ, binary_compressed PCD: with
/// how to decompress it)
std::unique_ptr<PointCloudReader> open_point_cloud(const std::filesystem::path& file);
/// The same of bytes that are open, at their first.
std::unique_ptr<PointCloudReader> open_point_cloud(BlockFile bytes);

}  // namespace vinerow::io
