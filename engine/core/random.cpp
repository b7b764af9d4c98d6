#include "engine/core/random.h"

#include <cmath>
#include <numbers>

#include "engine/core/hash.h"

namespace vinerow {

std::array<std::uint32_t, 4> philox4x32_10(std::array<std::uint32_t, 4> counter,
                                           std::array<std::uint32_t, 2> key) {
  // Multipliers and Weyl increments of the paper's table 2.
  constexpr std::uint64_t kM0 = 0xD2511F53, kM1 = 0xCD9E8D57;
  constexpr std::uint32_t kW0 = 0x9E3779B9, kW1 = 0xBB67AE85;
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t product0 = kM0 * counter[0];
    const std::uint64_t product1 = kM1 * counter[2];
    counter = {static_cast<std::uint32_t>(product1 >> 32) ^ counter[1] ^ key[0],
               static_cast<std::uint32_t>(product1),
               static_cast<std::uint32_t>(product0 >> 32) ^ counter[3] ^ key[1],
               static_cast<std::uint32_t>(product0)};
    key[0] += kW0;
    key[1] += kW1;
  }
  return counter;
}

namespace {

std::array<std::uint32_t, 2> split(std::uint64_t word) {
  return {static_cast<std::uint32_t>(word), static_cast<std::uint32_t>(word >> 32)};
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view vehicle, std::string_view component)
    : key_(split(seed)) {
  Hasher hasher;
  hasher.add(vehicle);
  hasher.add(component);
  stream_ = split(hash64(hasher.hex()));
}

std::uint64_t RandomStream::next_u64() {
  if (used_words_ == 4) {
    const auto counter = split(block_++);
    words_ = philox4x32_10({counter[0], counter[1], stream_[0], stream_[1]}, key_);
    used_words_ = 0;
  }
  const std::uint64_t low = words_[used_words_];
  const std::uint64_t high = words_[used_words_ + 1];
  used_words_ += 2;
  return low | (high << 32);
}

double RandomStream::uniform() {
  return static_cast<double>(next_u64() >> 11) * 0x1.0p-53;
}

double RandomStream::uniform(double low, double high) {
  return low + (high - low) * uniform();
}

double RandomStream::normal() {
  if (has_spare_normal_) {
    has_spare_normal_ = false;
    return spare_normal_;
  }
  // 1 - u is in (0, 1], so the logarithm is finite.
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_normal_ = radius * std::sin(angle);
  has_spare_normal_ = true;
  return radius * std::cos(angle);
}

}  // namespace vinerow
