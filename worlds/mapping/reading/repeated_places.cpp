#include "worlds/mapping/reading/repeated_places.h"

#include <utility>

namespace vinerow::mapping {
namespace {

constexpr std::size_t kSlots = 2 * RepeatedPlaces::kMax;
constexpr int kShift = 64 - std::countr_zero(kSlots);

}  // namespace

RepeatedPlaces::RepeatedPlaces() : slots_(kSlots) {}

void RepeatedPlaces::remember(std::uint64_t hash, std::uint64_t points) {
  if (hash == 0) hash = std::uint64_t{1} << 63;
  std::size_t at = static_cast<std::size_t>(hash >> kShift);
  while (slots_[at].hash != 0 && slots_[at].hash != hash) at = (at + 1) % kSlots;
  slots_[at].points += points;
  if (slots_[at].hash == hash) return;
  slots_[at].hash = hash;
  if (++places_ > kMax) thin();
}

/// Forgets every other place.
void RepeatedPlaces::thin() {
  skipped_ = 2 * skipped_ + 1;
  const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(kSlots));
  places_ = 0;
  for (const Slot& slot : old) {
    if (slot.hash != 0 && (slot.hash & skipped_) == 0) remember(slot.hash, slot.points);
  }
}

std::uint64_t RepeatedPlaces::count() const {
  std::uint64_t repeated = 0;
  for (const Slot& slot : slots_) repeated += slot.points > 1 ? slot.points - 1 : 0;
  return repeated * (skipped_ + 1);
}

}  // namespace vinerow::mapping
