#pragma once
/// Ring buffer of past values, so that late data are compared with the state at their own time.

#include <array>
#include <cstddef>

#include "engine/core/time.h"

namespace vinerow::controllers {

/// The last `Capacity` entries; a new one overwrites the oldest. No heap. @tparam Value with
/// interpolate(older, newer, share), found by its namespace, or + - and scalar *
template <class Value, std::size_t Capacity = 256>
class RecentTrace {
 public:
  void add(Time now, const Value& value) {
    entries_[next_] = {now, value};
    next_ = (next_ + 1) % Capacity;
    if (count_ < Capacity) ++count_;
  }
  /// Interpolates between the neighbours in time. Returns the oldest entry for earlier times and
  /// the newest for later ones. @pre !empty()
  Value at(Time time) const {
    const Entry* newer = &entry(0);
    if (time >= newer->time) return newer->value;
    for (std::size_t age = 1; age < count_; ++age) {
      const Entry& older = entry(age);
      if (time >= older.time) {
        const double share = (time - older.time).s() / (newer->time - older.time).s();
        return mix(older.value, newer->value, share);
      }
      newer = &older;
    }
    return newer->value;
  }
  bool empty() const { return count_ == 0; }
  void clear() { count_ = 0; }
  /// @pre !empty()
  Time oldest() const { return entry(count_ - 1).time; }

 private:
  struct Entry {
    Time time;
    Value value;
  };
  static Value mix(const Value& older, const Value& newer, double share) {
    if constexpr (requires { interpolate(older, newer, share); }) {
      return interpolate(older, newer, share);
    } else {
      return older + share * (newer - older);
    }
  }
  /// @param age  0 = newest
  const Entry& entry(std::size_t age) const {
    return entries_[(next_ + Capacity - 1 - age) % Capacity];
  }
  std::array<Entry, Capacity> entries_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace vinerow::controllers
