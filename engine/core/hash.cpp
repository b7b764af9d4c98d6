#include "engine/core/hash.h"

#include <fmt/format.h>
#include <xxhash.h>

namespace vinerow {

struct Hasher::State {
  XXH3_state_t* xxh = XXH3_createState();
  ~State() { XXH3_freeState(xxh); }
};

Hasher::Hasher() : state_(std::make_unique<State>()) {
  XXH3_128bits_reset(state_->xxh);
}
Hasher::~Hasher() = default;
Hasher::Hasher(Hasher&&) noexcept = default;
Hasher& Hasher::operator=(Hasher&&) noexcept = default;

/// What waits, and then these bytes.
void Hasher::pass_on(const void* data, std::size_t size) {
  XXH3_128bits_update(state_->xxh, waiting_.data(), waiting_count_);
  waiting_count_ = 0;
  XXH3_128bits_update(state_->xxh, data, size);
}

void Hasher::add(std::string_view text) {
  add(static_cast<std::uint64_t>(text.size()));
  add_bytes(text.data(), text.size());
}

std::string Hasher::hex() const {
  const State whole;
  XXH3_copyState(whole.xxh, state_->xxh);
  XXH3_128bits_update(whole.xxh, waiting_.data(), waiting_count_);
  const XXH128_hash_t digest = XXH3_128bits_digest(whole.xxh);
  return fmt::format("{:016x}{:016x}", digest.high64, digest.low64);
}

std::uint64_t hash64(std::string_view text) {
  return XXH64(text.data(), text.size(), 0);
}

}  // namespace vinerow
