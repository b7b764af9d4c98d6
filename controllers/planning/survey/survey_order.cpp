#include "controllers/planning/survey/survey_order.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "engine/core/check.h"
#include "engine/core/constants.h"

namespace vinerow::controllers {
namespace {

using Eigen::Vector2d;

// Chosen: above the rounding of sums, below any length that matters, so that ties do not depend on
// rounding.
constexpr double kLess_m = 1e-6;  // an order must be this much shorter to count as shorter
// Limits of the improvement, chosen for its run time, which grows with the third power of the
// lanes.
constexpr int kMaxPasses = 60;              // over all changes
constexpr int kLongestMoved = 4;            // lanes of a run that is moved
constexpr int kMaxImproved = 120;           // lanes; above, the best pattern is the result
constexpr int kFewLanes = 40;               // lanes; up to here more patterns are improved
constexpr std::size_t kImproved = 6;        // patterns that are improved with few lanes
constexpr std::size_t kImprovedOfMany = 2;  // patterns that are improved with more lanes

// Cost of an order l_1 ... l_n of lanes that are flown alternately up and down, the first one up or
// down (calc_extra_distance_m):
//
//   |start - entry(l_1)| + sum over i of turn(l_i, l_i+1) + |exit(l_n) - home|
//   turn(a, b) = |t_a - t_b| + |end_a - end_b| + (|t_a - t_b| < 2 R ? 8 R : 0)
//
// t is the position across the lanes and end the end of the lane at which the turn is: the upper
// one after a lane flown up. Both corners of a turn are level with the longer lane.
//
// Exact (Held and Karp): W(S, l) is the least cost of the set S of lanes that ends with lane l,
//
//   W({l}, l) = |start - entry(l)|,   W(S + m, m) = min over l in S of W(S, l) + turn(l, m)
//
// The direction of a lane follows from the size of S: it alternates. 2^n n^2 steps.
//
// Above kMaxExactLanes lanes: patterns (snake, racetrack, interleaved lanes of every stride,
// mirrored), the best of them improved by local search.

/// Distance from the start to the entry of a lane.
double calc_entry_distance_m(const OrderTask& task, int lane, bool up) {
  const LaneEnds& ends = task.lanes[lane];
  return (Vector2d(up ? ends.low_m : ends.high_m, ends.across_m) - task.start).norm();
}

/// Distance from the exit of a lane to home.
double calc_exit_distance_m(const OrderTask& task, int lane, bool up) {
  const LaneEnds& ends = task.lanes[lane];
  return (Vector2d(up ? ends.high_m : ends.low_m, ends.across_m) - task.home).norm();
}

void keep_better(const OrderTask& task, const std::vector<int>& lanes, LaneOrder& best) {
  for (const bool up : {true, false}) {
    const double distance_m = calc_extra_distance_m(task, lanes, up);
    if (distance_m < best.extra_distance_m - kLess_m) best = {lanes, up, distance_m};
  }
}

LaneOrder no_order() {
  LaneOrder order;
  order.extra_distance_m = kInfinity;
  return order;
}

/// Lanes 0, stride, 2 stride ..., then the classes between; with alternate, every other class is
/// reversed.
std::vector<int> interleave(int count, int stride, int first_class, bool alternate) {
  std::vector<int> lanes;
  for (int k = 0; k < stride; ++k) {
    std::vector<int> some;
    for (int i = (first_class + k) % stride; i < count; i += stride) some.push_back(i);
    if (alternate && k % 2 == 1) std::reverse(some.begin(), some.end());
    lanes.insert(lanes.end(), some.begin(), some.end());
  }
  return lanes;
}

/// 0, stride, 1, stride + 1, ...: a racetrack that advances by a lane on each lap, block after
/// block.
std::vector<int> racetrack(int count, int stride) {
  std::vector<int> lanes;
  for (int begin = 0; begin < count; begin += 2 * stride) {
    for (int i = begin; i < begin + stride; ++i) {
      if (i < count) lanes.push_back(i);
      if (i + stride < count) lanes.push_back(i + stride);
    }
  }
  return lanes;
}

/// Reverses runs of lanes, swaps lanes and moves short runs until no change shortens the order.
void improve(const OrderTask& task, LaneOrder& order) {
  const int n = static_cast<int>(order.lanes.size());
  bool better = true;
  const auto try_order = [&](const std::vector<int>& lanes) {
    const double before_m = order.extra_distance_m;
    keep_better(task, lanes, order);
    better |= order.extra_distance_m < before_m;
  };
  for (int pass = 0; pass < kMaxPasses && better; ++pass) {
    better = false;
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; ++j) {
        std::vector<int> lanes = order.lanes;
        std::reverse(lanes.begin() + i, lanes.begin() + j + 1);
        try_order(lanes);
        lanes = order.lanes;
        std::swap(lanes[i], lanes[j]);
        try_order(lanes);
      }
    }
    for (int length = 1; length <= kLongestMoved; ++length) {
      for (int i = 0; i + length <= n; ++i) {
        for (int to = 0; to + length <= n; ++to) {
          for (const bool reverse : {false, true}) {
            if (to == i) continue;
            std::vector<int> rest = order.lanes;
            std::vector<int> moved(rest.begin() + i, rest.begin() + i + length);
            if (reverse) std::reverse(moved.begin(), moved.end());
            rest.erase(rest.begin() + i, rest.begin() + i + length);
            rest.insert(rest.begin() + to, moved.begin(), moved.end());
            try_order(rest);
          }
        }
      }
    }
  }
}

}  // namespace

bool is_wide_turn(const LaneEnds& a, const LaneEnds& b, double turn_radius_m) {
  return std::abs(a.across_m - b.across_m) < 2.0 * turn_radius_m - kLess_m;
}

double calc_turn_length_m(const LaneEnds& a, const LaneEnds& b, bool at_high,
                          double turn_radius_m) {
  const double step_m = std::abs(a.across_m - b.across_m);
  // Both corners are level with the lane that reaches farther.
  const double uneven_m = at_high ? std::abs(a.high_m - b.high_m) : std::abs(a.low_m - b.low_m);
  return step_m + uneven_m + (is_wide_turn(a, b, turn_radius_m) ? 8.0 * turn_radius_m : 0.0);
}

double calc_extra_distance_m(const OrderTask& task, const std::vector<int>& lanes, bool starts_up) {
  bool up = starts_up;
  double distance_m = calc_entry_distance_m(task, lanes.front(), up);
  for (std::size_t i = 0; i + 1 < lanes.size(); ++i, up = !up) {
    distance_m +=
        calc_turn_length_m(task.lanes[lanes[i]], task.lanes[lanes[i + 1]], up, task.turn_radius_m);
  }
  return distance_m + calc_exit_distance_m(task, lanes.back(), up);
}

LaneOrder order_lanes_exactly(const OrderTask& task) {
  const int n = static_cast<int>(task.lanes.size());
  VINEROW_DEMAND(n >= 1 && n <= 20);
  const std::size_t sets = std::size_t{1} << n;
  LaneOrder best = no_order();
  for (const bool starts_up : {true, false}) {
    // W(set, last) at [set * n + last], and the lane before `last`.
    std::vector<double> distance_m(sets * n, kInfinity);
    std::vector<std::int8_t> before(sets * n, -1);
    for (int i = 0; i < n; ++i) {
      distance_m[(std::size_t{1} << i) * n + i] = calc_entry_distance_m(task, i, starts_up);
    }
    for (std::size_t set = 1; set < sets; ++set) {
      const bool up = starts_up == (__builtin_popcountll(set) % 2 == 1);
      for (int last = 0; last < n; ++last) {
        const double so_far_m = distance_m[set * n + last];
        if (so_far_m == kInfinity) continue;
        for (int next = 0; next < n; ++next) {
          if (set >> next & 1) continue;
          const double candidate_m =
              so_far_m +
              calc_turn_length_m(task.lanes[last], task.lanes[next], up, task.turn_radius_m);
          const std::size_t at = (set | std::size_t{1} << next) * n + next;
          if (candidate_m < distance_m[at] - kLess_m) {
            distance_m[at] = candidate_m;
            before[at] = static_cast<std::int8_t>(last);
          }
        }
      }
    }
    // Add the distance home, then follow the lanes back from the best end.
    const bool ends_up = starts_up == (n % 2 == 1);
    for (int last = 0; last < n; ++last) {
      const double candidate_m =
          distance_m[(sets - 1) * n + last] + calc_exit_distance_m(task, last, ends_up);
      if (candidate_m >= best.extra_distance_m - kLess_m) continue;
      best = {{}, starts_up, candidate_m};
      std::size_t set = sets - 1;
      for (int lane = last; lane >= 0;) {
        best.lanes.push_back(lane);
        const int previous = before[set * n + lane];
        set &= ~(std::size_t{1} << lane);
        lane = previous;
      }
      std::reverse(best.lanes.begin(), best.lanes.end());
    }
  }
  return best;
}

LaneOrder order_lanes_as_snake(const OrderTask& task) {
  std::vector<int> lanes(task.lanes.size());
  std::iota(lanes.begin(), lanes.end(), 0);
  LaneOrder best = no_order();
  keep_better(task, lanes, best);
  std::reverse(lanes.begin(), lanes.end());
  keep_better(task, lanes, best);
  return best;
}

LaneOrder order_lanes_by_improvement(const OrderTask& task) {
  const int n = static_cast<int>(task.lanes.size());
  // Patterns of all strides; only the best few are improved.
  std::vector<LaneOrder> orders = {order_lanes_as_snake(task)};
  for (int stride = 2; stride <= n; ++stride) {
    std::vector<std::vector<int>> patterns = {racetrack(n, stride)};
    for (const int first : {0, 1, stride - 1}) {
      patterns.push_back(interleave(n, stride, first, false));
      patterns.push_back(interleave(n, stride, first, true));
    }
    for (std::vector<int>& lanes : patterns) {
      for (int mirrored = 0; mirrored < 2; ++mirrored) {
        orders.push_back(no_order());
        keep_better(task, lanes, orders.back());
        for (int& lane : lanes) lane = n - 1 - lane;
      }
    }
  }
  std::stable_sort(orders.begin(), orders.end(), [](const LaneOrder& a, const LaneOrder& b) {
    return a.extra_distance_m < b.extra_distance_m;
  });
  const std::size_t worth = n > kMaxImproved ? 0 : n > kFewLanes ? kImprovedOfMany : kImproved;
  for (std::size_t i = 0; i < std::min(worth, orders.size()); ++i) improve(task, orders[i]);
  return *std::min_element(orders.begin(), orders.end(), [](const auto& a, const auto& b) {
    return a.extra_distance_m < b.extra_distance_m;
  });
}

LaneOrder order_lanes(const OrderTask& task) {
  const int n = static_cast<int>(task.lanes.size());
  return n <= kMaxExactLanes ? order_lanes_exactly(task) : order_lanes_by_improvement(task);
}

}  // namespace vinerow::controllers
