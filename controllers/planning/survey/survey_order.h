#pragma once
/// The order in which an aircraft flies parallel lanes: every lane once, with the least added way.
///
/// Lanes are flown up and down in turn. A U-turn by two corners of 90 degrees fits between lanes at
/// least two turning radii apart; nearer ones take a wide turn by four corners, which swings out by
/// two radii first and is 8 R longer. So where the lanes lie closer than that, skipping lanes is
/// what costs least.

#include <Eigen/Core>
#include <vector>

namespace vinerow::controllers {

/// A lane as the order sees it, in lane coordinates: its corners are where turns begin.
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
  std::vector<int> lanes;    ///< indices, in the order flown
  bool starts_up = true;     ///< the first lane is flown from low_m to high_m
  double added_way_m = 0.0;  ///< to the first lane, between lanes, home
};

/// Whether a turn between two lanes needs four corners.
bool is_wide_turn(const LaneEnds& a, const LaneEnds& b, double turn_radius_m);
/// Way of the turn from lane a to lane b, both at their upper or both at their lower ends.
double calc_turn_way_m(const LaneEnds& a, const LaneEnds& b, bool at_high, double turn_radius_m);
/// Of an order: added_way_m.
double calc_added_way_m(const OrderTask& task, const std::vector<int>& lanes, bool starts_up);

/// The best order: exact (dynamic programming over sets of flown lanes; Held and Karp, 1962) up to
/// kMostExactLanes lanes; beyond that the best of interleaved patterns, improved by moving and
/// reversing stretches until nothing gets shorter.
constexpr int kMostExactLanes = 14;
LaneOrder order_lanes(const OrderTask& task);
LaneOrder order_lanes_exactly(const OrderTask& task);  ///< @pre <= 20 lanes
LaneOrder order_lanes_by_improvement(const OrderTask& task);
/// Neighbour after neighbour, beginning at the best of the four corners.
LaneOrder order_lanes_as_snake(const OrderTask& task);

}  // namespace vinerow::controllers
