#pragma once
/// The public header block and the CRS of a LAS file.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>

#include "engine/io/files/block_file.h"

namespace vinerow::io {

struct LasHeader {
  int minor = 2;                 ///< of version 1.x
  int point_format = 0;          ///< 0 to 10
  std::size_t record_bytes = 0;  ///< of a point, with extra bytes
  std::uint64_t points_at = 0;   ///< byte of the first point
  std::uint64_t points_end = 0;  ///< byte after what may be points
  std::uint64_t point_count = 0;
  Eigen::Vector3d scale = {1, 1, 1};  ///< position = scale * integer + offset
  Eigen::Vector3d offset = {0, 0, 0};
  std::optional<Eigen::AlignedBox3d> bounds;  ///< nullopt where it cannot be (lower > upper)
  std::string crs;                            ///< as PointCloudInfo::crs
};

/// Bytes that the specification gives a point of the format 0 to 10.
std::size_t las_point_bytes(int format);
/// Byte of red in a point of the format; nullopt for formats without colour.
std::optional<std::size_t> las_colour_at(int format);

/// Reads header and variable length records, and checks that the points it counts are there.
/// @throws ConfigError naming the file and what is wrong; for LAZ with how to decompress it
LasHeader read_las_header(BlockFile& file);

}  // namespace vinerow::io
