#pragma once
/// Hash table from a cell of (x, y, heading) to the search tree's node in it. Open addressing with
/// lookup and overwrite only, so that nothing depends on its order. Allocates only when it doubles.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "controllers/parts/paths/pose2.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

class PoseCells {
 public:
  /// @param cell_m,cell_rad  > 0; headings are divided into round(2 pi / cell_rad) equal parts
  PoseCells(double cell_m, double cell_rad)
      : cell_m_(cell_m),
        headings_(std::max(1, static_cast<int>(std::lround(2.0 * kPi / cell_rad)))),
        slots_(1 << 14) {}

  /// Cell of a pose, counted from the origin of W. Positions up to +-1e6 cells.
  std::uint64_t key(const Pose2& pose) const {
    const auto i = static_cast<std::int64_t>(std::floor(pose.p.x() / cell_m_)) + (1 << 20);
    const auto j = static_cast<std::int64_t>(std::floor(pose.p.y() / cell_m_)) + (1 << 20);
    const double turns = pose.yaw_rad / (2.0 * kPi);
    const int h = static_cast<int>((turns - std::floor(turns)) * headings_) % headings_;
    return (static_cast<std::uint64_t>(i) << 40) | (static_cast<std::uint64_t>(j) << 16) |
           static_cast<std::uint64_t>(h);
  }

  /// @returns the node in the cell, -1 if it is empty
  int find(std::uint64_t key) const {
    const Slot& slot = slots_[place(key)];
    return slot.node;
  }

  void set(std::uint64_t key, int node) {
    if (2 * (count_ + 1) > slots_.size()) grow();
    Slot& slot = slots_[place(key)];
    if (slot.node < 0) ++count_;
    slot = {key, node};
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    int node = -1;
  };

  std::size_t place(std::uint64_t key) const {
    // Fibonacci hashing: the upper bits of the product are well mixed.
    std::size_t at = static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ull) >> 20);
    for (at &= slots_.size() - 1; slots_[at].node >= 0 && slots_[at].key != key;) {
      at = (at + 1) & (slots_.size() - 1);
    }
    return at;
  }

  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.node >= 0) slots_[place(slot.key)] = slot;
    }
  }

  double cell_m_;
  int headings_;
  std::vector<Slot> slots_;  // a power of two
  std::size_t count_ = 0;
};

}  // namespace vinerow::controllers
