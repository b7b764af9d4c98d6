#pragma once
/// Growable byte buffer for records and messages. Unlike std::vector it does not initialise new
/// bytes. It keeps its memory when cleared, so that a running recorder does not allocate.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string_view>

namespace vinerow::record {

// Numbers are copied to and from files in memory order; MCAP and our CDR are little-endian.
static_assert(std::endian::native == std::endian::little, "engine/record assumes little-endian");

class ByteBuffer {
 public:
  std::uint8_t* data() { return bytes_.get(); }
  const std::uint8_t* data() const { return bytes_.get(); }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::span<const std::uint8_t> view() const { return {bytes_.get(), size_}; }

  /// Removes the content, keeps the memory.
  void clear() { size_ = 0; }

  void reserve(std::size_t capacity) {
    if (capacity <= capacity_) return;
    std::unique_ptr<std::uint8_t[]> grown(new std::uint8_t[capacity]);
    if (size_ > 0) std::memcpy(grown.get(), bytes_.get(), size_);
    bytes_ = std::move(grown);
    capacity_ = capacity;
  }

  /// Changes the size; new bytes are undefined.
  void resize(std::size_t size) {
    ensure(size);
    size_ = size;
  }

  /// Adds `count` undefined bytes. @returns pointer to the first, valid until the next growth
  std::uint8_t* extend(std::size_t count) {
    ensure(size_ + count);
    std::uint8_t* first = bytes_.get() + size_;
    size_ += count;
    return first;
  }

  void add_bytes(const void* data, std::size_t count) {
    if (count > 0) std::memcpy(extend(count), data, count);
  }
  void add_zeros(std::size_t count) {
    if (count > 0) std::memset(extend(count), 0, count);
  }

  /// Appends a number in the byte order of MCAP and little-endian CDR, unaligned.
  template <class T>
  void add(T value) {
    std::memcpy(extend(sizeof value), &value, sizeof value);
  }
  /// Overwrites a number written before. @pre offset + sizeof value <= size()
  template <class T>
  void put(std::size_t offset, T value) {
    std::memcpy(bytes_.get() + offset, &value, sizeof value);
  }

 private:
  void ensure(std::size_t size) {
    if (size > capacity_) [[unlikely]] {
      reserve(size > 2 * capacity_ ? size : 2 * capacity_);
    }
  }

  std::unique_ptr<std::uint8_t[]> bytes_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace vinerow::record
