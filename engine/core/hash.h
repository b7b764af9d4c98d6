#pragma once
/// 128-bit digest of everything a run produced (XXH3). It detects differences; it is not for
/// security.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

namespace vinerow {

class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(Hasher&&) noexcept;
  Hasher& operator=(Hasher&&) noexcept;

  /// @param data  may be null where there are no bytes, as data() of an empty list is
  void add_bytes(const void* data, std::size_t size) {
    if (size == 0) return;  // memcpy must not see null
    if (size > waiting_.size() - waiting_count_) return pass_on(data, size);
    std::memcpy(waiting_.data() + waiting_count_, data, size);
    waiting_count_ += size;
  }

  /// Adds the bytes of arithmetic values and enums. -0.0 and 0.0 differ, as they do in the
  /// simulation.
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void add(T value) { add_bytes(&value, sizeof value); }

  /// Adds length and characters, so that ("ab","c") and ("a","bc") differ.
  void add(std::string_view text);

  /// Digest of everything added so far, 32 lower-case hexadecimal digits. More can be added
  /// afterwards.
  std::string hex() const;

 private:
  struct State;
  void pass_on(const void* data, std::size_t size);

  std::unique_ptr<State> state_;
  /// Signals are hashed field by field: a call of XXH3 for each would take longer than its work.
  std::array<std::byte, 512> waiting_{};
  std::size_t waiting_count_ = 0;
};

/// Stateless 64-bit hash of a text, the same on every machine. Used to key random streams.
std::uint64_t hash64(std::string_view text);

}  // namespace vinerow
