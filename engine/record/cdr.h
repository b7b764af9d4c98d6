#pragma once
/// CDR, the encoding of ROS 2 messages: XCDR version 1, little-endian.
///
/// Source: OMG "DDS Interoperability Wire Protocol" 2.2, section 10 (encapsulation header 00 01 00
/// 00 = CDR_LE), and OMG CORBA 3 part 2, section 9.3 (alignment). Every number is aligned to its
/// own size, counted from the first byte after the 4-byte encapsulation header; strings are a
/// 32-bit length that counts the closing zero; sequences are a 32-bit count and the elements.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "engine/record/byte_buffer.h"

namespace vinerow::record {

constexpr std::size_t kCdrHeaderSize = 4;

/// Writer of one message to the end of a buffer; starts with the encapsulation header.
class CdrWriter {
 public:
  explicit CdrWriter(ByteBuffer& out) : out_(out) {
    const std::uint8_t header[kCdrHeaderSize] = {0, 1, 0, 0};
    out_.add_bytes(header, sizeof header);
    origin_ = out_.size();
  }

  template <class T>
  requires std::is_arithmetic_v<T>
  void add(T value) {
    align(sizeof value);
    out_.add(value);
  }
  void add(bool value) { out_.add(static_cast<std::uint8_t>(value)); }
  void add(std::string_view text) {
    add(static_cast<std::uint32_t>(text.size() + 1));
    out_.add_bytes(text.data(), text.size());
    out_.add(std::uint8_t{0});
  }
  /// One string, joined from two.
  void add_joined(std::string_view first, std::string_view second) {
    add(static_cast<std::uint32_t>(first.size() + second.size() + 1));
    out_.add_bytes(first.data(), first.size());
    out_.add_bytes(second.data(), second.size());
    out_.add(std::uint8_t{0});
  }
  /// Count of a sequence; the elements follow.
  void add_count(std::size_t count) { add(static_cast<std::uint32_t>(count)); }
  /// Doubles of a fixed-size array, or of a sequence after its count.
  void add_doubles(const double* values, std::size_t count) {
    if (count == 0) return;
    align(8);
    out_.add_bytes(values, count * sizeof(double));
  }
  /// Numbers of `size` bytes each in memory order, of an array or of a sequence after its count.
  void add_numbers(const void* values, std::size_t count, std::size_t size) {
    if (count == 0) return;
    align(size);
    out_.add_bytes(values, count * size);
  }
  void add_zero_doubles(std::size_t count) {
    align(8);
    out_.add_zeros(count * sizeof(double));
  }
  void add(const Eigen::Vector3d& v) { add_doubles(v.data(), 3); }
  /// Elements of a sequence of points, after its count.
  void add(std::span<const Eigen::Vector3d> points) {
    static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
    if (!points.empty()) add_doubles(points.front().data(), 3 * points.size());
  }
  /// Adds the bytes of a sequence, after its count. @returns pointer to the first; fill them before
  /// the next call
  std::uint8_t* extend_octets(std::size_t count) { return out_.extend(count); }

 private:
  void align(std::size_t size) {
    const std::size_t over = (out_.size() - origin_) & (size - 1);
    if (over != 0) out_.add_zeros(size - over);
  }

  ByteBuffer& out_;
  std::size_t origin_ = 0;
};

/// Reader of one message. Reading past the end, or a count that cannot fit, sets ok() to false; all
/// later values are zero. Nothing throws.
class CdrReader {
 public:
  explicit CdrReader(std::span<const std::uint8_t> message) : bytes_(message) {
    // Only CDR_LE is supported, the encoding that this project writes.
    ok_ = bytes_.size() >= kCdrHeaderSize && bytes_[0] == 0 && bytes_[1] == 1;
    at_ = kCdrHeaderSize;
  }

  bool ok() const { return ok_; }
  std::size_t remaining() const { return ok_ ? bytes_.size() - at_ : 0; }

  template <class T>
  T read() {
    static_assert(std::is_arithmetic_v<T>);
    T value{};
    align(sizeof value);
    take(&value, sizeof value);
    return value;
  }
  bool read_bool() { return read<std::uint8_t>() != 0; }
  void read(std::string& text) {
    const std::string_view view = read_text();
    text.assign(view.data(), view.size());
  }
  /// View of a text in the message, without its closing zero.
  std::string_view read_text() {
    const auto size = read<std::uint32_t>();
    // Some writers omit the zero of an empty string and write length 0.
    if (size == 0 || !fits(size)) return {};
    const auto* first = reinterpret_cast<const char*>(bytes_.data() + at_);
    at_ += size;
    if (first[size - 1] != '\0') ok_ = false;
    return ok_ ? std::string_view(first, size - 1) : std::string_view();
  }
  /// @param min_element_size  minimum size of an element in bytes. It bounds the count by the
  /// remaining bytes, so that a damaged count cannot request more memory than the message has
  /// bytes.
  std::size_t read_count(std::size_t min_element_size) {
    const auto count = read<std::uint32_t>();
    return fits(std::size_t{count} * min_element_size) ? count : 0;
  }
  void read_doubles(double* values, std::size_t count) {
    if (count == 0) return;
    align(8);
    take(values, count * sizeof(double));
  }
  void read(Eigen::Vector3d& v) { read_doubles(v.data(), 3); }
  void read(std::span<Eigen::Vector3d> points) {
    if (!points.empty()) read_doubles(points.front().data(), 3 * points.size());
  }
  void read_octets(std::uint8_t* values, std::size_t count) {
    if (count > 0) take(values, count);
  }
  void skip_doubles(std::size_t count) {
    align(8);
    if (fits(count * sizeof(double))) at_ += count * sizeof(double);
  }

 private:
  void align(std::size_t size) {
    const std::size_t over = (at_ - kCdrHeaderSize) & (size - 1);
    if (over != 0) at_ += size - over;
  }
  bool fits(std::size_t size) {
    if (ok_ && at_ <= bytes_.size() && bytes_.size() - at_ >= size) return true;
    ok_ = false;
    return false;
  }
  void take(void* out, std::size_t size) {
    if (!fits(size)) {
      std::memset(out, 0, size);
      return;
    }
    std::memcpy(out, bytes_.data() + at_, size);
    at_ += size;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool ok_ = false;
};

}  // namespace vinerow::record
