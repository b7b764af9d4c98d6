#pragma once
/// Clouds of a topic as files for PCL, Open3D, CloudCompare and MeshLab.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "tools/export/cloud_message.h"
#include "tools/export/listed_files.h"

namespace vinerow::tools {

enum class CloudFormat { kPcd, kPly };

/// ".pcd" or ".ply"
const char* ending_of(CloudFormat format);

/// Header of a binary little-endian file (PCD 0.7, PLY 1.0) of points without gaps between their
/// fields. Equally long for any number of points.
std::string cloud_header(CloudFormat format, std::span<const CloudField> fields,
                         std::uint64_t points);

/// Writes each cloud of a topic, in the sensor's own frame, into a folder; the list has frame_id
/// and points.
class ScanFiles {
 public:
  /// @param folder  as for ListedFiles
  ScanFiles(std::filesystem::path folder, CloudFormat format);

  /// @param stamp_ns  for the file's name  @param message  a PointCloud2
  /// @returns false, and writes nothing, if it is none
  /// @throws ConfigError if the file cannot be written
  bool add(std::int64_t stamp_ns, std::int64_t logged_ns, std::span<const std::uint8_t> message);
  /// Writes the list. @returns number of clouds
  int finish() { return files_.finish(); }

 private:
  ListedFiles files_;
  CloudFormat format_;
};

}  // namespace vinerow::tools
