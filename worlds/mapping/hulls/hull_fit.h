#pragma once
/// Fit of a hull to the points of a stretch of row: least volume for a number of points outside.
///
/// The cost  volume + price * (points farther than the tolerance outside a face)  is minimised over
/// the offsets h of every side of every section, one at a time. The volume is linear in a small
/// change of one offset (its slope is an area of the side), and the points outside change only
/// where a point passes a face, so that the minimum is at one of these places. The caller sets the
/// price so that as many points are outside as are allowed.

#include <cstdint>
#include <functional>
#include <vector>

#include "worlds/mapping/hulls/excess_counts.h"
#include "worlds/mapping/hulls/hull_chain.h"
#include "worlds/mapping/hulls/row_sections.h"

namespace vinerow::mapping {

/// Thresholds of the fit, all chosen.
struct HullFitOptions {
  /// Price of a point below the hull, in points: pictures show few low points, and the lower edge
  /// must not rise above them.
  double down_price = 20.0;
  /// Vertical part of the normal below which a side looks down: 17 degrees below the horizontal.
  double looks_down = -0.3;
  // Smoothing of the lower edge.
  /// Along the row: less than half the distance between vines, so that the gap between two trunks
  /// stays.
  double edge_reach_m = 0.4;
  double edge_band_m = 0.1;      ///< some leaves
  double edge_few_per_m = 50.0;  ///< points; a dense cloud shows more on one side of a row
  /// Largest move of a neighbour's side when a section is removed: a third of the depth that
  /// collect() looks at then.
  double removal_move_m = 0.05;
};

/// Removal of one section.
struct Removal {
  double added_m3 = 0.0;  ///< cost in volume and price of points; never falls in the order of
                          ///< removals
  int knot = 0, before = 0, behind = 0;
  std::vector<double> h_m;  ///< offsets of the sections before and behind, after it
};

/// Hull of one stretch during the fit.
class HullFit {
 public:
  /// Starts with the offsets that leave one point in a hundred of each slice outside.
  /// @param stretch  must outlive this object
  HullFit(const RowStretch& stretch, const HullDirections& directions,
          const HullFitOptions& options = {});

  int sections() const { return left_; }
  double length_m() const { return stretch_.to_m - stretch_.from_m; }
  /// Area of all sides, and of side k.
  double side_area_m2() const;
  double side_area_m2(int k) const;
  double volume_m3() const;

  /// Collects the points that are outside each side, or may be once it has moved in by `reach_m`.
  /// Until the next call, sides move in by no more than that.
  void collect(double reach_m);
  /// Improves every side of every section once. @param max_m  largest move of a side
  void sweep(double price_m3, double tolerance_m, double max_m);
  void count_excess(ExcessCounts& counts) const;
  /// Appends the points with a larger excess, and all points beyond the stretch's ends.
  void find_above(double excess_m, std::vector<Eigen::Vector3f>& points) const;
  /// Moves the lowest side out to its outermost offset within edge_reach_m along the row, if few
  /// low points were seen there (edge_few_per_m within edge_band_m of the side) and as far as the
  /// section stays convex. Pictures from above do not show the lowest leaves of every slice, but
  /// the underside of a canopy is even over a few slices.
  void smooth_lower_edge();
  /// Moves all sides out, or in if negative.
  void offset(double out_m);
  const std::vector<double>& offsets() const { return h_; }
  void set_offsets(const std::vector<double>& h_m) { h_ = h_m; }

  /// Removals of sections, the cheapest first, until both no more than `fewest` sections are left
  /// and the next removal costs more than `max_m3`. The hull itself is unchanged.
  /// @param may_join  true if the straight line between two knots stays close to the row's line
  std::vector<Removal> find_removals(double price_m3, double tolerance_m, double max_m3, int fewest,
                                     const std::function<bool(double, double)>& may_join);
  /// Carries out the first `count` removals.
  void apply(const std::vector<Removal>& removals, std::size_t count);

  HullChain chain() const;

 private:
  struct Candidate {
    float s_m;  ///< from the start of the stretch
    float v_m;  ///< n_k . (y, z)
  };

  double* h(int j) { return h_.data() + static_cast<std::size_t>(j) * c_; }
  const double* h(int j) const { return h_.data() + static_cast<std::size_t>(j) * c_; }
  double at_m(int j) const { return knots_[j]; }
  double slope_m2(int j, int k) const;
  void improve(int j, int k, double price_m3, double tolerance_m, double max_m);
  std::int64_t outside(int a, int b, double tolerance_m) const;
  double cost(int a, int b, double price_m3, double tolerance_m) const;
  double try_without(int j, double price_m3, double tolerance_m, Removal* made);
  void drop(int j);

  const RowStretch& stretch_;
  HullDirections directions_;
  HullFitOptions options_;
  int c_ = 0;
  int left_ = 0;
  std::vector<double> knots_;     // s of each section, from the start of the stretch
  std::vector<int> prev_, next_;  // linked list of the sections that are left; -1 at the ends
  std::vector<double> h_, floor_;
  std::vector<Candidate> candidates_;  // by slice and side, the outermost first
  std::vector<std::uint32_t> begins_;
  std::vector<double> breaks_;
};

}  // namespace vinerow::mapping
