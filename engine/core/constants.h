#pragma once
/// Numbers that many parts need.

#include <limits>

namespace vinerow {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// By which weights, load factors and data sheets count; a world may have another gravity.
inline constexpr double kStandardGravity_mps2 = 9.80665;

}  // namespace vinerow
