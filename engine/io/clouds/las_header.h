#pragma once
/// Public header block and CRS of a LAS file.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>

#include "engine/io/files/block_file.h"

namespace vinerow::io {

struct LasHeader {
  int minor = 2;                 ///< of version 1.x
  int point_format = 0;          ///< 0 to 10
  std::size_t record_bytes = 0;  ///< of a point record, extra bytes included
  std::uint64_t points_at = 0;   ///< offset of the first point
  std::uint64_t points_end = 0;  ///< offset of the end of the point data
  std::uint64_t point_count = 0;
  Eigen::Vector3d scale = {1, 1, 1};  ///< position = scale * integer + offset
  Eigen::Vector3d offset = {0, 0, 0};
  std::optional<Eigen::AlignedBox3d> bounds;  ///< nullopt if invalid (lower > upper)
  std::string crs;                            ///< as PointCloudInfo::crs
};

/// Size of a point record of format 0 to 10 by the specification, in bytes.
std::size_t las_point_bytes(int format);
/// Offset of the red value in a point record; nullopt for formats without colour.
std::optional<std::size_t> las_colour_at(int format);

/// Reads the header and the variable length records, and checks that the file has the counted
/// points.
/// @throws ConfigError naming the file and the fault; for LAZ also how to decompress it
LasHeader read_las_header(BlockFile& file);

}  // namespace vinerow::io
