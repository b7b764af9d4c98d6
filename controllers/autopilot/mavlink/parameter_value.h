#pragma once
/// Values of parameters in the one float that MAVLink has for them.
///
/// ArduPilot converts: 3 is 3.0F, whatever the parameter's type is. PX4 puts the bytes of whole
/// numbers there. Source: MAVLink's guide, "Parameter protocol", C cast and bytewise encoding.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/mavlink/enums.h"

namespace vinerow::controllers {

enum class ParameterEncoding { kConverted, kBytewise };

/// The nearest whole number that the type holds.
template <class Whole>
Whole nearest(double value) {
  using Limits = std::numeric_limits<Whole>;
  return static_cast<Whole>(std::clamp<double>(std::round(value), Limits::min(), Limits::max()));
}

/// @param type  MAV_PARAM_TYPE; whole numbers other than 32 bits wide are not read bytewise
inline float to_wire(double value, std::uint8_t type, ParameterEncoding encoding) {
  if (encoding == ParameterEncoding::kConverted) return static_cast<float>(value);
  if (type == mavlink::kParameterInt32) {
    return std::bit_cast<float>(nearest<std::int32_t>(value));
  }
  if (type == mavlink::kParameterUint32) {
    return std::bit_cast<float>(nearest<std::uint32_t>(value));
  }
  return static_cast<float>(value);
}

inline double from_wire(float value, std::uint8_t type, ParameterEncoding encoding) {
  if (encoding == ParameterEncoding::kConverted) return value;
  if (type == mavlink::kParameterInt32) return std::bit_cast<std::int32_t>(value);
  if (type == mavlink::kParameterUint32) return std::bit_cast<std::uint32_t>(value);
  return value;
}

}  // namespace vinerow::controllers
