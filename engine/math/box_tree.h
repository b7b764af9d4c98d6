#pragma once
/// Bounding volume hierarchy over boxes, for exact searches of the nearest item.
///
/// Built top-down by median split along the longest axis of the centres; equal boxes give equal
/// trees. A node has the size of a box and 8 bytes, an item 4 bytes.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

namespace vinerow {

/// @tparam Scalar  of the boxes: float or double, in 2 or 3 dimensions as instantiated below
template <class Scalar, int kDimension>
class BoxTree {
 public:
  using Box = Eigen::AlignedBox<Scalar, kDimension>;

  BoxTree() = default;
  /// An item is the index of its box. Fewer than 2^32 items.
  explicit BoxTree(std::span<const Box> boxes);

  /// Calls `visit(item)` for items whose box may be nearer than sqrt(best2_m2), nearest branches
  /// first. No heap, thread safe.
  /// @param distance2  lower bound, m2, of the squared distance to what is in a box:
  ///   double(const Box&). Where two boxes at once are cheaper, also
  ///   Array2d(const Box&, const Box&)
  /// @param best2_m2  `visit` may lower it; it is read again after each call
  template <class Distance2, class Visit>
  void search(const Distance2& distance2, const double& best2_m2, Visit&& visit) const {
    if (nodes_.empty()) return;
    struct Open {
      std::uint32_t node;
      double bound2_m2;
    };
    // The depth of a median split of 2^32 items is at most 32; one sibling waits per level.
    Open stack[64];
    int open_count = 0;
    stack[open_count++] = {0, distance2(nodes_[0].box)};
    while (open_count > 0) {
      const Open open = stack[--open_count];
      if (open.bound2_m2 >= best2_m2) continue;
      const Node& node = nodes_[open.node];
      if (node.count > 0) {
        for (std::uint32_t k = 0; k < node.count; ++k) visit(items_[node.link + k]);
        continue;
      }
      Open left{open.node + 1, 0.0}, right{node.link, 0.0};
      const Box &left_box = nodes_[left.node].box, &right_box = nodes_[right.node].box;
      if constexpr (requires { distance2(left_box, right_box); }) {
        const Eigen::Array2d both = distance2(left_box, right_box);
        left.bound2_m2 = both[0];
        right.bound2_m2 = both[1];
      } else {
        left.bound2_m2 = distance2(left_box);
        right.bound2_m2 = distance2(right_box);
      }
      const bool left_first = left.bound2_m2 <= right.bound2_m2;
      stack[open_count++] = left_first ? right : left;
      stack[open_count++] = left_first ? left : right;
    }
  }

 private:
  struct Node {
    Box box;
    std::uint32_t link;   ///< leaf: first item; else: right child (the left one follows its parent)
    std::uint32_t count;  ///< > 0: leaf
  };

  std::uint32_t build(std::span<const Box> boxes, std::uint32_t begin, std::uint32_t end);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

extern template class BoxTree<float, 3>;
extern template class BoxTree<double, 2>;

}  // namespace vinerow
