#pragma once
/// 128-bit digest of everything a run produced (XXH3). It detects differences; it is not for
/// security.

#include <cstddef>
#include <cstdint>
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

  void add_bytes(const void* data, std::size_t size);

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
  std::unique_ptr<State> state_;
};

/// Stateless 64-bit hash of a text, the same on every machine. Used to key random streams.
std::uint64_t hash64(std::string_view text);

}  // namespace vinerow
