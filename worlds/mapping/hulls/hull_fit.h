#pragma once
/// Where the faces of a hull along a row lie: least volume for the points that it leaves outside.
///
/// Minimised is  volume + price * (points farther than the tolerance outside a face)  over the
/// offsets h of every side of every section, one at a time and exactly, since the volume is linear
/// in one offset (its slope is the side's area) and the points outside change only where a point
/// passes a face. The price is set so that as many points are outside as are allowed.

#include <cstdint>
#include <functional>
#include <vector>

#include "worlds/mapping/hulls/excess_counts.h"
#include "worlds/mapping/hulls/hull_chain.h"
#include "worlds/mapping/hulls/row_sections.h"

namespace vinerow::mapping {

/// Leaving out of one section.
struct Removal {
  double added_m3 = 0.0;  ///< volume and price of points that it cost, or a later one less than it
  int knot = 0, before = 0, behind = 0;
  std::vector<double> h_m;  ///< of the sections before and behind, afterwards
};

/// The hull of one stretch while it is being fitted.
class HullFit {
 public:
  /// Starts from the level of each slice that one point in a hundred is outside of.
  /// @param stretch  outlives this
  HullFit(const RowStretch& stretch, const HullDirections& directions);

  int sections() const { return left_; }
  double length_m() const { return stretch_.to_m - stretch_.from_m; }
  /// Area of all sides.
  double side_area_m2() const;
  double side_area_m2(int k) const;
  double volume_m3() const;

  /// Finds which points may come to lie outside which side. After that sides move in by no more
  /// than `reach_m` before the next time.
  void collect(double reach_m);
  /// Every side of every section once. @param most_m  farthest that one moves
  void sweep(double price_m3, double tolerance_m, double most_m);
  void count_excess(ExcessCounts& counts) const;
  /// Appends the points whose excess is more than that.
  void find_above(double excess_m, std::vector<Eigen::Vector3f>& points) const;
  /// Where few low points were seen (50 in a metre of row at most within 0.1 m of it) the side that
  /// looks down goes out to where it lies farthest out within 0.4 m along the row, as far as the
  /// section stays convex: pictures from above do not see the lowest leaves of every slice, and the
  /// underside is even over some slices all the same.
  void even_the_foot();
  /// All sides out, or in.
  void offset(double out_m);
  const std::vector<double>& offsets() const { return h_; }
  void set_offsets(const std::vector<double>& h_m) { h_ = h_m; }

  /// Sections left out in the order of what that costs, until `fewest` are left or the next costs
  /// more than `most_m3`, whichever comes last. Nothing of this is kept.
  /// @param may_join  whether the line between two knots stays close to the row's
  std::vector<Removal> find_removals(double price_m3, double tolerance_m, double most_m3,
                                     int fewest,
                                     const std::function<bool(double, double)>& may_join);
  /// Leaves out the sections of the first `count` removals.
  void apply(const std::vector<Removal>& removals, std::size_t count);

  HullChain chain() const;

 private:
  struct Candidate {
    float s_m;  ///< from the stretch's begin
    float v_m;  ///< n_k . (y, z)
  };

  double* h(int j) { return h_.data() + static_cast<std::size_t>(j) * c_; }
  const double* h(int j) const { return h_.data() + static_cast<std::size_t>(j) * c_; }
  double at_m(int j) const { return knots_[j]; }
  double slope_m2(int j, int k) const;
  void improve(int j, int k, double price_m3, double tolerance_m, double most_m);
  std::int64_t outside(int a, int b, double tolerance_m) const;
  double cost(int a, int b, double price_m3, double tolerance_m) const;
  double try_without(int j, double price_m3, double tolerance_m, Removal* made);
  void drop(int j);

  const RowStretch& stretch_;
  HullDirections directions_;
  int c_ = 0;
  int left_ = 0;
  std::vector<double> knots_;     // s of each from the stretch's begin
  std::vector<int> prev_, next_;  // sections that are left; -1 at the ends
  std::vector<double> h_, floor_;
  std::vector<Candidate> candidates_;  // by slice and side
  std::vector<std::uint32_t> begins_;
  std::vector<double> breaks_;
};

}  // namespace vinerow::mapping
