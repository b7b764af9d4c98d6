#pragma once
/// Decoding of a cloud (sensor_msgs/PointCloud2) by its own description.

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/record/cdr.h"
#include "engine/record/ros_schema.h"

namespace vinerow::tools {

/// One number of each point.
struct CloudField {
  std::string name;  ///< valid UTF-8
  std::uint32_t offset = 0;
  record::RosKind kind = record::RosKind::kFloat32;

  bool operator==(const CloudField&) const = default;
};

struct CloudMessage {
  std::uint32_t height = 0, width = 0;
  std::uint32_t point_step = 0, row_step = 0;
  std::vector<CloudField> fields;  ///< those of one number of a known type; within a point
  std::vector<std::uint8_t> data;

  std::size_t size() const { return std::size_t{height} * width; }
  /// Bytes of point i, row by row. @pre i < size()
  const std::uint8_t* point(std::size_t i) const {
    return data.data() + i / width * row_step + i % width * point_step;
  }
};

/// Whether messages of this type are clouds.
bool is_cloud_type(const std::string& ros_type);

/// Reads what follows the header. @returns nothing if the description does not fit the bytes
std::optional<CloudMessage> read_cloud(record::CdrReader& in);

}  // namespace vinerow::tools
