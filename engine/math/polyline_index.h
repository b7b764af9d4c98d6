#pragma once
/// Index of polylines in the plane, such as the rows of a map, that finds the nearest ones to a
/// point.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "engine/math/box_tree.h"
#include "engine/math/polyline.h"

namespace vinerow {

class PolylineIndex {
 public:
  struct Nearest : Polyline::Nearest {
    int line = -1;  ///< index of the polyline; -1: there is none, and the distance is +infinity
  };

  PolylineIndex() = default;
  /// Segments without length and segments that are not finite do not count.
  explicit PolylineIndex(std::vector<Polyline> lines);

  /// Nearest point of all lines: equal to the bit to Polyline::nearest() of each. Among equals, the
  /// lowest line and then the lowest segment. No heap, thread safe.
  Nearest nearest(const Eigen::Vector2d& p) const;

  /// Nearest points of the two nearest lines, by the same rule.
  std::array<Nearest, 2> nearest_two(const Eigen::Vector2d& p) const;

  /// Calls `visit` for every segment with a point within `reach_m`, and maybe for others that are
  /// farther. In no order; a line comes once for each of its segments. No heap, thread safe.
  void visit_within(const Eigen::Vector2d& p, double reach_m,
                    const std::function<void(const Nearest&)>& visit) const;

  const std::vector<Polyline>& lines() const { return lines_; }

 private:
  struct Segment {
    int line, number;
  };
  /// Calls `look(nearest)` for the segments that may be nearer than reach_m.
  template <class Look>
  void search(const Eigen::Vector2d& p, const double& reach_m, Look&& look) const;

  std::vector<Polyline> lines_;
  std::vector<Segment> segments_;
  // Boxes lie along the lines' prevailing direction, or those of slanting rows would overlap.
  Eigen::Matrix2d from_W_ = Eigen::Matrix2d::Identity();
  BoxTree<double, 2> tree_;
  double largest_m_ = 0.0;  // coordinate
};

}  // namespace vinerow
