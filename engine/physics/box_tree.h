#pragma once
/// Bounding volume hierarchy over boxes, for distance queries from an oriented box.
///
/// Built top-down by median split along the longest axis of the centres; equal boxes give equal
/// trees. 32 bytes per node, 4 bytes per item.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace vinerow::physics {

/// Oriented box relative to a tree's frame T: a point p_T is R_OT * p_T + p_OT in the box's own
/// frame O, where the box is |x_i| <= half_extents_m_i.
struct QueryBox {
  Eigen::Matrix3d R_OT = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_OT = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_extents_m = Eigen::Vector3d::Zero();
};

class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::span<const Eigen::AlignedBox3f> boxes);

  /// Calls `visit(item)` for items whose box may be nearer to the query than sqrt(best2_m2),
  /// nearest branches first. `visit` may lower `best2_m2`, which is read again after each call.
  template <class Visit>
  void search(const QueryBox& query, const double& best2_m2, Visit&& visit) const {
    if (nodes_.empty()) return;
    const Eigen::Matrix3d R_abs = query.R_OT.cwiseAbs();
    struct Open {
      std::uint32_t node;
      double bound2_m2;
    };
    // The depth of a median split of 2^32 items is at most 32; one sibling waits per level.
    Open stack[64];
    int open_count = 0;
    stack[open_count++] = {0, calc_bound2(nodes_[0], query, R_abs)};
    while (open_count > 0) {
      const Open open = stack[--open_count];
      if (open.bound2_m2 >= best2_m2) continue;
      const Node& node = nodes_[open.node];
      if (node.count > 0) {
        for (std::uint32_t k = 0; k < node.count; ++k) visit(items_[node.link + k]);
        continue;
      }
      const std::uint32_t left = open.node + 1;
      const std::uint32_t right = node.link;
      const double left2 = calc_bound2(nodes_[left], query, R_abs);
      const double right2 = calc_bound2(nodes_[right], query, R_abs);
      const bool left_first = left2 <= right2;
      stack[open_count++] = left_first ? Open{right, right2} : Open{left, left2};
      stack[open_count++] = left_first ? Open{left, left2} : Open{right, right2};
    }
  }

 private:
  struct Node {
    Eigen::Vector3f low;
    Eigen::Vector3f high;
    std::uint32_t link;   ///< leaf: first item; else: right child (the left one follows its parent)
    std::uint32_t count;  ///< > 0: leaf
  };

  /// Lower bound of the squared distance between the query and the node's box: their separation
  /// along the query's axes.
  static double calc_bound2(const Node& node, const QueryBox& query, const Eigen::Matrix3d& R_abs) {
    const Eigen::Vector3d centre = 0.5 * (node.low + node.high).cast<double>();
    const Eigen::Vector3d half = 0.5 * (node.high - node.low).cast<double>();
    const Eigen::Vector3d gap =
        (query.R_OT * centre + query.p_OT).cwiseAbs() - query.half_extents_m - R_abs * half;
    return gap.cwiseMax(0.0).squaredNorm();
  }

  std::uint32_t build(std::span<const Eigen::AlignedBox3f> boxes, std::uint32_t begin,
                      std::uint32_t end);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

}  // namespace vinerow::physics
