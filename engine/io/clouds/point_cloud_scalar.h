#pragma once
/// Numbers in the files of point clouds: bytes of a given order and type, and text.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

namespace vinerow::io {

enum class Scalar { kI8, kU8, kI16, kU16, kI32, kU32, kI64, kU64, kF32, kF64 };

/// Bytes of one number.
std::size_t size_of(Scalar type);
inline bool is_real(Scalar type) {
  return type == Scalar::kF32 || type == Scalar::kF64;
}

/// The number whose bytes begin at `bytes`, aligned or not.
template <class T>
T load(const std::uint8_t* bytes, std::endian order = std::endian::little) {
  std::array<std::uint8_t, sizeof(T)> own;
  std::memcpy(own.data(), bytes, sizeof(T));
  if (order != std::endian::native) std::reverse(own.begin(), own.end());
  return std::bit_cast<T>(own);
}

/// The same by a type known when the file is read. 64-bit integers beyond 2^53 are rounded.
double load(Scalar type, const std::uint8_t* bytes, std::endian order);

/// A decimal number and nothing else: "-1.5e3", "+2", "nan", "inf"; what is too large is infinite,
/// what is too small is 0.
std::optional<double> parse_number(std::string_view text);
/// A whole number >= 0 and nothing else.
std::optional<std::uint64_t> parse_count(std::string_view text);
/// What may stand between the words of a line.
inline bool is_blank(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r' && c != '\n');
}
/// The next word of a line after blanks; "" at its end. `line` loses what was read.
std::string_view next_word(std::string_view* line);

}  // namespace vinerow::io
