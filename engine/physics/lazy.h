#pragma once
/// Value that is made when it is needed first. Most of a world's meshes are never near a vehicle.

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

#include "engine/core/profile.h"

namespace vinerow::physics {

/// Thread safe: one thread makes the value, others wait for it. Once made, reading it costs one
/// atomic load.
template <class T>
class Lazy {
 public:
  explicit Lazy(std::function<T()> make) : make_(std::move(make)) {}

  const T& get() const {
    const T* made = made_.load(std::memory_order_acquire);
    return made ? *made : make();
  }

 private:
  const T& make() const {
    std::call_once(once_, [this] {
      const ProfileSpan span("trees of distances and contacts", "set-up");
      value_.emplace(make_());
      made_.store(&*value_, std::memory_order_release);
    });
    return *value_;
  }

  std::function<T()> make_;
  mutable std::once_flag once_;
  mutable std::optional<T> value_;
  mutable std::atomic<const T*> made_{nullptr};
};

}  // namespace vinerow::physics
