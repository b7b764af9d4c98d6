#include "engine/math/box_tree.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

namespace vinerow {
namespace {

// Items of a leaf are tested one by one. Chosen: few enough to be fast, enough to keep the tree
// small.
constexpr std::uint32_t kLeafItems = 6;

/// Moves the `half` items with the lowest centres along the axis to the front, equal ones by index.
/// Sorting copies of the centres saves a lookup of two boxes in each comparison.
template <class Box>
void divide(std::span<const Box> boxes, int axis, std::size_t half,
            std::span<std::uint32_t> items) {
  using Key = std::pair<typename Box::Scalar, std::uint32_t>;
  constexpr std::size_t kFew = 128;
  std::array<Key, kFew> few;
  std::vector<Key> many(items.size() > kFew ? items.size() : 0);
  const std::span<Key> keys = many.empty() ? std::span(few).first(items.size()) : std::span(many);
  for (std::size_t k = 0; k < items.size(); ++k) {
    keys[k] = {boxes[items[k]].center()[axis], items[k]};
  }
  std::nth_element(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(half), keys.end());
  for (std::size_t k = 0; k < items.size(); ++k) items[k] = keys[k].second;
}

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
  const std::uint32_t half = (end - begin) / 2, middle = begin + half;
  divide(boxes, axis, half, std::span(items_).subspan(begin, end - begin));
  build(boxes, begin, middle);
  const std::uint32_t right = build(boxes, middle, end);
  nodes_[index].link = right;
  nodes_[index].count = 0;
  return index;
}

template class BoxTree<float, 3>;
template class BoxTree<double, 2>;

}  // namespace vinerow
