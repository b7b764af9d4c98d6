#include "engine/math/box_tree.h"

#include <algorithm>
#include <vector>

namespace vinerow {
namespace {

// Items of a leaf are tested one by one. Chosen: few enough to be fast, enough to keep the tree
// small.
constexpr std::uint32_t kLeafItems = 6;

/// An item with the centre of its box: what a split reads and moves lies side by side in memory.
template <class Box>
struct Entry {
  typename Box::VectorType centre;
  std::uint32_t item;
};

/// Moves the `half` entries with the lowest centres along the longest side of all centres to the
/// front, equal ones by item.
template <class Box>
void divide(std::size_t half, std::span<Entry<Box>> entries) {
  Box centres;
  for (const Entry<Box>& entry : entries) centres.extend(entry.centre);
  int axis = 0;
  centres.sizes().maxCoeff(&axis);
  const auto is_before = [axis](const Entry<Box>& a, const Entry<Box>& b) {
    return a.centre[axis] < b.centre[axis] || (a.centre[axis] == b.centre[axis] && a.item < b.item);
  };
  std::nth_element(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(half),
                   entries.end(), is_before);
}

}  // namespace

template <class Scalar, int kDimension>
BoxTree<Scalar, kDimension>::BoxTree(std::span<const Box> boxes) {
  if (boxes.empty()) return;
  nodes_.reserve(boxes.size() / kLeafItems * 4 + 1);
  build(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
  nodes_.shrink_to_fit();
}

template <class Scalar, int kDimension>
std::uint32_t BoxTree<Scalar, kDimension>::build(std::span<const Box> boxes, std::uint32_t begin,
                                                 std::uint32_t end) {
  std::vector<Entry<Box>> entries(end - begin);
  for (std::uint32_t k = begin; k < end; ++k) entries[k - begin] = {boxes[k].center(), k};
  // A node precedes its children; its box is theirs together.
  const auto make = [&](const auto& self, std::span<Entry<Box>> some) -> std::uint32_t {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    Box bounds;
    if (some.size() <= kLeafItems) {
      nodes_[index].link = static_cast<std::uint32_t>(items_.size());
      nodes_[index].count = static_cast<std::uint32_t>(some.size());
      for (const Entry<Box>& entry : some) {
        bounds.extend(boxes[entry.item]);
        items_.push_back(entry.item);
      }
    } else {
      const std::size_t half = some.size() / 2;
      divide<Box>(half, some);
      const std::uint32_t left = self(self, some.first(half));
      const std::uint32_t right = self(self, some.subspan(half));
      bounds.extend(nodes_[left].box);
      bounds.extend(nodes_[right].box);
      nodes_[index].link = right;
      nodes_[index].count = 0;
    }
    nodes_[index].box = bounds;
    return index;
  };
  items_.reserve(entries.size());
  return make(make, entries);
}

template class BoxTree<float, 3>;
template class BoxTree<double, 2>;

}  // namespace vinerow
