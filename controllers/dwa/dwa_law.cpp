#include "controllers/dwa/dwa_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

// Rounding of distances between cell centres: standing still must stay free.
constexpr double kStandingSlack_m = 1e-3;
// Of equals, the one that steers least: per rad of both axles, far below any weight of J.
constexpr double kCalmness_per_rad = 0.01;

/// `count` values from low to high, both included.
double spread(double low, double high, int i, int count) {
  return count > 1 ? low + (high - low) * i / (count - 1) : 0.5 * (low + high);
}

/// Mean over a step in which an angle moves from one value to another, at a rate of `most` per
/// step.
double mean_angle(double from, double to, double most) {
  return to - 0.5 * (to - from) * std::abs(to - from) / most;
}

}  // namespace

double calc_score(const DwaTerms& terms, const DwaCost& cost) {
  if (cost.as_printed) {
    return cost.clearance_weight * terms.clearance_m + cost.goal_weight * terms.goal_m;
  }
  return cost.clearance_weight * std::min(terms.clearance_m, cost.saturation_m) -
         cost.goal_weight * terms.goal_m - cost.heading_weight * std::abs(terms.heading_error_rad) -
         cost.path_weight * terms.path_m;
}

void calc_sweep(const AxleAngles& steering, const AxleAngles& target,
                const SteeredVehicle& geometry, double step_s, SteeringSweep* out) {
  const double most_rad = geometry.steer_rate_radps * step_s;
  AxleAngles now = steering;
  out->count = 0;
  bool is_moving = true;
  while (is_moving && out->count < Rollout::kMost) {
    // The mean angles of the step; once the axles stand, the arc is exact.
    const AxleAngles next = turn_axles(now, target, most_rad);
    const RollingMotion motion = calc_motion({mean_angle(now.front_rad, next.front_rad, most_rad),
                                              mean_angle(now.rear_rad, next.rear_rad, most_rad)},
                                             geometry);
    out->steps[out->count++] = {motion.curvature_per_m, direction(motion.course_rad)};
    is_moving = next.front_rad != now.front_rad || next.rear_rad != now.rear_rad;
    now = next;
  }
}

void roll_out(const Pose2& start, double v_mps, const SteeringSweep& sweep, double horizon_s,
              double step_s, Rollout* out) {
  const int steps =
      std::clamp(static_cast<int>(std::ceil(horizon_s / step_s - 1e-9)), 1, Rollout::kMost);
  const double length_m = v_mps * step_s;
  Rollout::Node node{start.p, direction(start.yaw_rad), start.yaw_rad};
  // Of one step, in B: where the centre goes (see advance()) and how the heading turns.
  Eigen::Vector2d move_B = Eigen::Vector2d::Zero(), turned = Eigen::Vector2d::UnitX();
  double turn_rad = 0.0;
  for (int i = 0; i < steps; ++i) {
    if (i < sweep.count) {
      const SteeringSweep::Step& step = sweep.steps[i];
      turn_rad = length_m * step.curvature_per_m;
      const double half = 0.5 * turn_rad;
      const Eigen::Vector2d by_half = direction(half);
      const double chord_m = std::abs(half) < 1e-8 ? length_m : length_m * by_half.y() / half;
      move_B = chord_m * (by_half.x() * step.course + by_half.y() * left_of(step.course));
      turned = by_half.x() * by_half + by_half.y() * left_of(by_half);
    }
    node.p += move_B.x() * node.ahead + move_B.y() * left_of(node.ahead);
    node.ahead = turned.x() * node.ahead + turned.y() * left_of(node.ahead);
    node.yaw_rad += turn_rad;
    out->nodes[i] = node;
  }
  out->count = steps;
}

void roll_out(const Pose2& start, double v_mps, const AxleAngles& steering,
              const AxleAngles& target, const SteeredVehicle& geometry, double horizon_s,
              double step_s, Rollout* out) {
  SteeringSweep sweep;
  calc_sweep(steering, target, geometry, step_s, &sweep);
  roll_out(start, v_mps, sweep, horizon_s, step_s, out);
}

DwaTerms DwaLaw::judge(const Rollout& rollout, const DwaTask& task) const {
  const LocalPath& path = *task.path;
  DwaTerms terms;
  int near = task.path_hint;
  for (int i = 0; i < rollout.count; ++i) {
    near = path.nearest(rollout.nodes[i].p, near);
    terms.path_m += path.distance_m(rollout.nodes[i].p, near);
  }
  const Rollout::Node& end = rollout.nodes[rollout.count - 1];
  terms.path_m /= rollout.count;
  terms.heading_error_rad = wrap_angle(end.yaw_rad - path[near].yaw_rad);
  terms.goal_m = (end.p - task.goal_W).norm();
  terms.clearance_m = rooms_.measure_cover(outline_, end.p, end.ahead).least_m();
  return terms;
}

Room DwaLaw::calc_need(const Pose2& pose, const Room& wanted) const {
  const Room now = rooms_.measure(outline_, pose);
  return {std::min(wanted.known_m, now.known_m - kStandingSlack_m),
          std::min(wanted.unknown_m, now.unknown_m - kStandingSlack_m)};
}

DwaChoice DwaLaw::choose(const DwaState& state, const DwaTask& task) const {
  VINEROW_ASSERT(task.path != nullptr && !task.path->empty());
  const double reach_mps = params_.acceleration_mps2 * params_.window_s;
  const double v_low = std::clamp(state.v_mps - reach_mps, task.v_low_mps, task.v_high_mps);
  const double v_high = std::clamp(state.v_mps + reach_mps, task.v_low_mps, task.v_high_mps);
  const double limit = params_.geometry.max_axle_steer_rad;
  const double turn_rad = params_.geometry.steer_rate_radps * params_.window_s;
  const auto window = [&](double angle_rad) {
    return std::pair{std::clamp(angle_rad - turn_rad, -limit, limit),
                     std::clamp(angle_rad + turn_rad, -limit, limit)};
  };
  const auto [front_low, front_high] = window(state.steering.front_rad);
  const auto [rear_low, rear_high] = window(state.steering.rear_rad);

  DwaChoice best;
  best.steering = state.steering;
  best.score = -std::numeric_limits<double>::infinity();
  double best_stop_m = -std::numeric_limits<double>::infinity();
  Rollout rollout;
  SteeringSweep sweep;
  for (int i = 0; i < params_.steers; ++i) {
    for (int j = 0; j < params_.steers; ++j) {
      const AxleAngles target{spread(front_low, front_high, i, params_.steers),
                              spread(rear_low, rear_high, j, params_.steers)};
      calc_sweep(state.steering, target, params_.geometry, params_.step_s, &sweep);
      for (int k = 0; k < params_.speeds; ++k) {
        const double v = spread(v_low, v_high, k, params_.speeds);
        // Whatever the horizon, as far as it takes to stop.
        const double stop_s = 0.5 * std::abs(v) / params_.acceleration_mps2;
        roll_out(state.pose, v, sweep, std::max(params_.horizon_s, stop_s), params_.step_s,
                 &rollout);
        int free = 0;
        while (free < rollout.count && rooms_.meets(outline_, rollout.nodes[free].p,
                                                    rollout.nodes[free].ahead, task.need)) {
          ++free;
        }
        const double travel_m = std::abs(v) * params_.step_s * free;
        if (free < rollout.count) {
          // Something is in the way: only for braking, if nothing better is found.
          const double stop_m = travel_m - 0.5 * v * v / params_.acceleration_mps2;
          if (!best.is_admissible && stop_m > best_stop_m) {
            best_stop_m = stop_m;
            best.v_mps = stop_m > 0.0 ? v : 0.0;
            best.steering = target;
            best.travel_m = travel_m;
          }
          continue;
        }
        const double calm = std::abs(target.front_rad - state.steering.front_rad) +
                            std::abs(target.rear_rad - state.steering.rear_rad);
        const double score =
            calc_score(judge(rollout, task), params_.cost) - kCalmness_per_rad * calm;
        if (best.is_admissible && score <= best.score) continue;
        best = {v, target, true, score, {}, travel_m};
      }
    }
  }
  roll_out(state.pose, best.v_mps, state.steering, best.steering, params_.geometry,
           params_.horizon_s, params_.step_s, &rollout);
  best.room = rooms_.measure(outline_, state.pose);
  for (int i = 0; best.is_admissible && i < rollout.count; ++i) {
    const Room room = rooms_.measure(outline_, rollout.nodes[i].p, rollout.nodes[i].ahead);
    best.room = {std::min(best.room.known_m, room.known_m),
                 std::min(best.room.unknown_m, room.unknown_m)};
  }
  return best;
}

}  // namespace vinerow::controllers
