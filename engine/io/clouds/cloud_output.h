#pragma once
/// The bytes of a point cloud that is being written.

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "engine/core/whole_file.h"
#include "engine/io/clouds/point_cloud.h"

namespace vinerow::io {

/// A file written from its start, with places overwritten at the end.
class CloudOutput {
 public:
  /// @throws ConfigError where the file cannot be made
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
  /// Writes what was put where that has become much: call it after each point.
  void flush_if_long() {
    constexpr std::size_t kLong = 1 << 16;
    if (pending_.size() >= kLong) flush();
  }
  /// Writes what was put. @throws WriteError where the disk refuses
  void flush();
  /// Overwrites what lies at a byte from the start, after a flush.
  void overwrite_text(std::uint64_t at, std::string_view bytes);
  template <class T>
  void overwrite(std::uint64_t at, T value) {
    const auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    overwrite_text(at, {bytes.data(), bytes.size()});
  }
  /// Ends the file, which has its name from here on. @throws WriteError where it is not whole
  void close();

  /// @throws ConfigError where a coordinate is not finite
  void check_finite(const CloudPoint& point) const;
  /// "point cloud 'file' sentence" as ConfigError.
  [[noreturn]] void fail(const std::string& sentence) const;

 private:
  std::filesystem::path file_;
  WholeFile out_;
  std::string pending_;
};

}  // namespace vinerow::io
