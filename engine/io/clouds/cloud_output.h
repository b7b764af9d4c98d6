#pragma once
/// Output buffer of the point cloud writers.

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "engine/core/whole_file.h"
#include "engine/io/clouds/point_cloud.h"

namespace vinerow::io {

/// File that is written from start to end, then patched at given positions.
class CloudOutput {
 public:
  /// @throws ConfigError if the file cannot be created
  explicit CloudOutput(const std::filesystem::path& file);

  /// Little-endian.
  template <class T>
  void put(T value) {
    static_assert(std::endian::native == std::endian::little);
    const auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    pending_.append(bytes.data(), bytes.size());
  }
  /// The text, and NULs up to `padded_to` bytes.
  void put_text(std::string_view text, std::size_t padded_to = 0) {
    pending_ += text;
    if (text.size() < padded_to) pending_.append(padded_to - text.size(), '\0');
  }
  /// Writes the pending bytes if there are 64 KiB of them or more. Call it after each point.
  void flush_if_long() {
    constexpr std::size_t kLong = 1 << 16;
    if (pending_.size() >= kLong) flush();
  }
  /// Writes the pending bytes. @throws WriteError if the write fails
  void flush();
  /// Overwrites bytes at an offset from the start of the file. @pre flush() was called
  void overwrite_text(std::uint64_t at, std::string_view bytes);
  template <class T>
  void overwrite(std::uint64_t at, T value) {
    const auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    overwrite_text(at, {bytes.data(), bytes.size()});
  }
  /// Closes the file and gives it its final name. @throws WriteError if it is incomplete
  void close();

  /// @throws ConfigError if a coordinate is not finite
  void check_finite(const CloudPoint& point) const;
  /// "point cloud 'file' sentence" as ConfigError.
  [[noreturn]] void fail(const std::string& sentence) const;

 private:
  std::filesystem::path file_;
  WholeFile out_;
  std::string pending_;
};

}  // namespace vinerow::io
