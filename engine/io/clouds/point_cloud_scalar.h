#pragma once
/// Decoding of numbers in point cloud files: bytes of a given order and type, and text.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

#include "engine/io/files/block_file.h"

namespace vinerow::io {

enum class Scalar { kI8, kU8, kI16, kU16, kI32, kU32, kI64, kU64, kF32, kF64 };

/// Size of one number in bytes.
std::size_t size_of(Scalar type);
inline bool is_real(Scalar type) {
  return type == Scalar::kF32 || type == Scalar::kF64;
}

/// The number stored at `bytes`, aligned or not.
template <class T>
T load(const std::uint8_t* bytes, std::endian order = std::endian::little) {
  std::array<std::uint8_t, sizeof(T)> own;
  std::memcpy(own.data(), bytes, sizeof(T));
  if (order != std::endian::native) std::reverse(own.begin(), own.end());
  return std::bit_cast<T>(own);
}

/// The same for a type known at run time. 64-bit integers beyond 2^53 are rounded.
double load(Scalar type, const std::uint8_t* bytes, std::endian order);

/// Parses a text that is one decimal number: "-1.5e3", "+2", "nan", "inf". Overflow gives infinity,
/// underflow 0.
std::optional<double> parse_number(std::string_view text);
/// Parses a text that is one whole number >= 0.
std::optional<std::uint64_t> parse_count(std::string_view text);
/// True for characters that separate the words of a line.
inline bool is_blank(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r' && c != '\n');
}
/// Removes the next word from the front of `line`, with the blanks before it; "" at the end.
std::string_view next_word(std::string_view* line);

/// Reads the next line that is not blank. @param is_comment  lines to leave out, by their first
/// word
/// @returns false at the end of the file
bool next_line(BlockFile& file, std::string_view* line,
               bool (*is_comment)(std::string_view word) = nullptr);
/// Number in the line just read. @throws ConfigError "... has 'abc' as x in line 5, must be a
/// number"
double number_in(const BlockFile& file, std::string_view word, std::string_view name);

}  // namespace vinerow::io
