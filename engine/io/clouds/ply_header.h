#pragma once
/// Header of a PLY file.

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/clouds/point_cloud_scalar.h"
#include "engine/io/files/block_file.h"

namespace vinerow::io {

struct PlyProperty {
  std::string name;
  Scalar type = Scalar::kF32;             ///< of the value, or of a list's values
  std::optional<Scalar> list_count_type;  ///< set: a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  bool has_lists() const;
  std::size_t fixed_bytes() const;  ///< bytes of one instance without its lists, in a binary file
};

struct PlyHeader {
  bool ascii = false;
  std::endian order = std::endian::little;  ///< byte order of a binary file
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;  ///< without the word "comment"; at most 100
};

/// Reads up to and including end_header. @throws ConfigError naming file, line and fault
PlyHeader read_ply_header(BlockFile& file);

}  // namespace vinerow::io
