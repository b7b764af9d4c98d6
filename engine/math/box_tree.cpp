#include "engine/math/box_tree.h"

#include <algorithm>
#include <numeric>

namespace vinerow {
namespace {

// Items of a leaf are tested one by one. Chosen: few enough to be fast, enough to keep the tree
// small.
constexpr std::uint32_t kLeafItems = 6;

}  // namespace

template <class Scalar, int kDimension>
BoxTree<Scalar, kDimension>::BoxTree(std::span<const Box> boxes) {
  if (boxes.empty()) return;
  items_.resize(boxes.size());
  std::iota(items_.begin(), items_.end(), 0u);
  nodes_.reserve(boxes.size() / kLeafItems * 4 + 1);
  build(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
  nodes_.shrink_to_fit();
}

template <class Scalar, int kDimension>
std::uint32_t BoxTree<Scalar, kDimension>::build(std::span<const Box> boxes, std::uint32_t begin,
                                                 std::uint32_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Box bounds, centres;
  for (std::uint32_t k = begin; k < end; ++k) {
    bounds.extend(boxes[items_[k]]);
    centres.extend(boxes[items_[k]].center());
  }
  nodes_[index].box = bounds;
  if (end - begin <= kLeafItems) {
    nodes_[index].link = begin;
    nodes_[index].count = end - begin;
    return index;
  }
  int axis = 0;
  centres.sizes().maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const Scalar centre_a = boxes[a].center()[axis];
                     const Scalar centre_b = boxes[b].center()[axis];
                     return centre_a != centre_b ? centre_a < centre_b : a < b;
                   });
  build(boxes, begin, middle);
  const std::uint32_t right = build(boxes, middle, end);
  nodes_[index].link = right;
  nodes_[index].count = 0;
  return index;
}

template class BoxTree<float, 3>;
template class BoxTree<double, 2>;

}  // namespace vinerow
