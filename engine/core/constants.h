#pragma once
/// Constants that many parts use.

#include <limits>

namespace vinerow {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Standard gravity, for weights, load factors and data sheets; a world may have another gravity.
inline constexpr double kStandardGravity_mps2 = 9.80665;

}  // namespace vinerow
