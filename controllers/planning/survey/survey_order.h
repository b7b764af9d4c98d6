#pragma once
/// Order in which an aircraft flies parallel lanes: every lane once, with the least extra distance.
///
/// Lanes are flown up and down alternately. A U-turn with two corners of 90 degrees fits between
/// lanes at least two turning radii R apart. Closer lanes need a wide turn with four corners, which
/// first swings out by two radii and is 8 R longer. Skipping lanes is then cheaper.

#include <Eigen/Core>
#include <vector>

namespace vinerow::controllers {

/// Ends of a lane in lane coordinates: the points where turns start.
struct LaneEnds {
  double across_m = 0.0;
  double low_m = 0.0;
  double high_m = 0.0;
};

struct OrderTask {
  std::vector<LaneEnds> lanes;
  double turn_radius_m = 25.0;
  Eigen::Vector2d start = {0, 0};  ///< (s, t)
  Eigen::Vector2d home = {0, 0};
};

struct LaneOrder {
  std::vector<int> lanes;         ///< indices, in the order flown
  bool starts_up = true;          ///< the first lane is flown from low_m to high_m
  double extra_distance_m = 0.0;  ///< to the first lane, between lanes, home
};

/// Whether a turn between two lanes needs four corners.
bool is_wide_turn(const LaneEnds& a, const LaneEnds& b, double turn_radius_m);
/// Length of the turn from lane a to lane b between their upper ends (at_high) or their lower ends.
double calc_turn_length_m(const LaneEnds& a, const LaneEnds& b, bool at_high, double turn_radius_m);
/// LaneOrder::extra_distance_m of an order.
double calc_extra_distance_m(const OrderTask& task, const std::vector<int>& lanes, bool starts_up);

/// Best order: exact (dynamic programming over sets of flown lanes; Held and Karp, 1962) up to
/// kMaxExactLanes lanes. Beyond that, the best of interleaved patterns, improved by moving and
/// reversing runs of lanes until no change shortens it.
constexpr int kMaxExactLanes = 14;
LaneOrder order_lanes(const OrderTask& task);
LaneOrder order_lanes_exactly(const OrderTask& task);  ///< @pre <= 20 lanes
LaneOrder order_lanes_by_improvement(const OrderTask& task);
/// Lanes in spatial order, starting at the best of the four corners.
LaneOrder order_lanes_as_snake(const OrderTask& task);

}  // namespace vinerow::controllers
