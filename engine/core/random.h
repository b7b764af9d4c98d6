#pragma once
/// Counter-based random numbers: one independent stream per (run seed, vehicle, component).
///
/// Source: Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC'11, the
/// Philox4x32-10 generator. A stream depends only on the seed and its names, so an additional
/// vehicle or sensor does not change the noise of the others. Cost: no heap, 4 words of state. A
/// copy of a stream keeps its position.

#include <array>
#include <cstdint>
#include <string_view>

namespace vinerow {

/// One Philox4x32-10 block. @returns four 32-bit words for this counter and key.
std::array<std::uint32_t, 4> philox4x32_10(std::array<std::uint32_t, 4> counter,
                                           std::array<std::uint32_t, 2> key);

class RandomStream {
 public:
  /// @param component  name that is unique inside the vehicle, e.g. "gps"
  RandomStream(std::uint64_t seed, std::string_view vehicle, std::string_view component);

  std::uint64_t next_u64();
  /// Uniform in [0, 1), 53 bits.
  double uniform();
  /// Uniform in [low, high). @param low,high finite, low <= high
  double uniform(double low, double high);
  /// Standard normal (Box-Muller; two uniforms give two normals, the second is kept for the next
  /// call).
  double normal();

 private:
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 2> stream_;
  std::uint64_t block_ = 0;
  std::array<std::uint32_t, 4> words_{};
  int used_words_ = 4;
  double spare_normal_ = 0.0;
  bool has_spare_normal_ = false;
};

}  // namespace vinerow
