#pragma once
/// Header of a PCD file.

#include <cstdint>
#include <string>
#include <vector>

#include "engine/io/clouds/point_cloud_scalar.h"
#include "engine/io/files/block_file.h"

namespace vinerow::io {

struct PcdField {
  std::string name;
  Scalar type = Scalar::kF32;
  std::size_t count = 1;  ///< values of this field in a point
  std::size_t at = 0;     ///< offset of the first value in a binary point
};

struct PcdHeader {
  bool ascii = false;
  std::uint64_t points = 0;
  std::size_t point_bytes = 0;  ///< of a binary point
  std::vector<PcdField> fields;
};

/// Reads up to and including the line DATA. @throws ConfigError naming the file and the fault
PcdHeader read_pcd_header(BlockFile& file);

}  // namespace vinerow::io
