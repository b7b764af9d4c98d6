#pragma once
/// What signals do with the fields that a message lists: the digest, and the search for NaN.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/core/hash.h"

namespace vinerow {

/// Feeds every field of a message to the digest.
struct HashField {
  Hasher& hasher;

  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(const T& value) { hasher.add(value); }
  void operator()(const std::string& text) { hasher.add(std::string_view(text)); }
  void operator()(const Eigen::Vector3d& v) { hasher.add_bytes(v.data(), sizeof(double) * 3); }
  void operator()(const Eigen::Quaterniond& q) {
    hasher.add_bytes(q.coeffs().data(), sizeof(double) * 4);
  }
  void operator()(const std::vector<double>& values) {
    hasher.add(static_cast<std::uint64_t>(values.size()));
    hasher.add_bytes(values.data(), values.size() * sizeof(double));
  }
  void operator()(const std::vector<std::uint8_t>& bytes) {
    hasher.add(static_cast<std::uint64_t>(bytes.size()));
    hasher.add_bytes(bytes.data(), bytes.size());
  }
  void operator()(const std::vector<std::string>& texts) {
    hasher.add(static_cast<std::uint64_t>(texts.size()));
    for (const std::string& text : texts) hasher.add(std::string_view(text));
  }
};

/// Finds a field that is not a number.
struct NanField {
  bool found = false;

  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(const T& value) {
    if constexpr (std::is_floating_point_v<T>) found = found || std::isnan(value);
  }
  void operator()(const std::string&) {}
  void operator()(const Eigen::Vector3d& v) { found = found || v.array().isNaN().any(); }
  void operator()(const Eigen::Quaterniond& q) {
    found = found || q.coeffs().array().isNaN().any();
  }
  void operator()(const std::vector<double>& values) {
    for (const double value : values) found = found || std::isnan(value);
  }
  void operator()(const std::vector<std::uint8_t>&) {}
  void operator()(const std::vector<std::string>&) {}
};

}  // namespace vinerow
