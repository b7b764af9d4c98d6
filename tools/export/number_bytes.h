#pragma once
/// Numbers of a message whose type is known only when it is read.

#include <cstdint>
#include <cstring>

#include "engine/record/ros_schema.h"

namespace vinerow::tools {

template <class T>
double number_of_type(const void* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

/// The number whose little-endian bytes these are; beyond 2^53 the nearest double. A byte of
/// another kind, such as a bool, counts as itself.
inline double number_of(record::RosKind kind, const void* bytes) {
  switch (kind) {
    case record::RosKind::kInt8:
      return number_of_type<std::int8_t>(bytes);
    case record::RosKind::kInt16:
      return number_of_type<std::int16_t>(bytes);
    case record::RosKind::kUint16:
      return number_of_type<std::uint16_t>(bytes);
    case record::RosKind::kInt32:
      return number_of_type<std::int32_t>(bytes);
    case record::RosKind::kUint32:
      return number_of_type<std::uint32_t>(bytes);
    case record::RosKind::kInt64:
      return number_of_type<std::int64_t>(bytes);
    case record::RosKind::kUint64:
      return number_of_type<std::uint64_t>(bytes);
    case record::RosKind::kFloat32:
      return number_of_type<float>(bytes);
    case record::RosKind::kFloat64:
      return number_of_type<double>(bytes);
    default:
      return number_of_type<std::uint8_t>(bytes);
  }
}

}  // namespace vinerow::tools
