#include "controllers/dwa/dwa_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

// Plan of DwaLaw::choose(), with a = acceleration_mps2, T = window_s and v_0, d_F0, d_R0 the
// present motion. One pass over speeds x steers x steers samples:
//   1. Sample (v, d_F, d_R): v within v_0 +- a T, each angle within its present value +- rate T,
//      all within their limits.
//   2. Roll it out at constant v. The rollout lasts at least v / (2 a), in which v covers the
//      braking distance v^2 / (2 a).
//   3. Admissible: every pose has the clearance `need`. Score: J minus a small term for steering.
//   4. If no sample is admissible: brake on the rollout with the longest remainder of the free
//      distance after braking, travel - v^2 / (2 a).
//
// One step of a rollout covers `length` = v step_s. It is an arc of curvature k that turns by
// 2 half = length k, so its chord has the length `length` sin(half) / half and the direction
// course + half.

// Rounding of distances between cell centres, chosen: a stop must stay free.
constexpr double kStationarySlack_m = 1e-3;
// Prefers the least steering among samples of equal J; chosen far below any default weight of J.
constexpr double kCalmness_per_rad = 0.01;
// Rounding of horizon / step, in steps: a whole quotient must not gain a step.
constexpr double kStepSlack = 1e-9;
// Half the turn of a step below which sin(half) / half is 1 to within rounding.
constexpr double kStraightHalf_rad = 1e-8;

/// `count` values from low to high, both included.
double spread(double low, double high, int i, int count) {
  return count > 1 ? low + (high - low) * i / (count - 1) : 0.5 * (low + high);
}

/// Mean over a step in which an angle moves from one value to another, at a rate of `max_step` per
/// step.
double mean_angle(double from, double to, double max_step) {
  return to - 0.5 * (to - from) * std::abs(to - from) / max_step;
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
  const double max_rad = geometry.steer_rate_radps * step_s;
  AxleAngles now = steering;
  out->count = 0;
  bool is_moving = true;
  while (is_moving && out->count < Rollout::kMax) {
    // The mean angles of the step; once the axles rest, the arc is exact.
    const AxleAngles next = turn_axles(now, target, max_rad);
    const RollingMotion motion = calc_motion({mean_angle(now.front_rad, next.front_rad, max_rad),
                                              mean_angle(now.rear_rad, next.rear_rad, max_rad)},
                                             geometry);
    out->steps[out->count++] = {motion.curvature_per_m, direction(motion.course_rad)};
    is_moving = next.front_rad != now.front_rad || next.rear_rad != now.rear_rad;
    now = next;
  }
}

void roll_out(const Pose2& start, double v_mps, const SteeringSweep& sweep, double horizon_s,
              double step_s, Rollout* out) {
  const int steps =
      std::clamp(static_cast<int>(std::ceil(horizon_s / step_s - kStepSlack)), 1, Rollout::kMax);
  const double length_m = v_mps * step_s;
  Rollout::Node node{start.p, direction(start.yaw_rad), start.yaw_rad};
  // Of one step, in B: displacement of the centre and rotation of the heading.
  Eigen::Vector2d move_B = Eigen::Vector2d::Zero(), turned = Eigen::Vector2d::UnitX();
  double turn_rad = 0.0;
  for (int i = 0; i < steps; ++i) {
    if (i < sweep.count) {
      const SteeringSweep::Step& step = sweep.steps[i];
      turn_rad = length_m * step.curvature_per_m;
      const double half = 0.5 * turn_rad;
      const Eigen::Vector2d by_half = direction(half);
      const double chord_m =
          std::abs(half) < kStraightHalf_rad ? length_m : length_m * by_half.y() / half;
      move_B = chord_m * (by_half.x() * step.course + by_half.y() * left_of(step.course));
      // Rotation by 2 half, by the formulas of the double angle.
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
  terms.clearance_m = free_space_.measure_cover(outline_, end.p, end.ahead).min_m();
  return terms;
}

FreeSpace DwaLaw::calc_need(const Pose2& pose, const FreeSpace& wanted) const {
  const FreeSpace now = free_space_.measure(outline_, pose);
  return {std::min(wanted.known_m, now.known_m - kStationarySlack_m),
          std::min(wanted.unknown_m, now.unknown_m - kStationarySlack_m)};
}

DwaChoice DwaLaw::choose(const DwaState& state, const DwaTask& task) const {
  VINEROW_ASSERT(task.path != nullptr && !task.path->empty());
  // The dynamic window: commands that can be reached within window_s.
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
        // At least as far as the braking distance: v stop_s = v^2 / (2 a).
        const double stop_s = 0.5 * std::abs(v) / params_.acceleration_mps2;
        roll_out(state.pose, v, sweep, std::max(params_.horizon_s, stop_s), params_.step_s,
                 &rollout);
        // Number of poses before the first that lacks clearance.
        int free = 0;
        while (free < rollout.count && free_space_.meets(outline_, rollout.nodes[free].p,
                                                         rollout.nodes[free].ahead, task.need)) {
          ++free;
        }
        const double travel_m = std::abs(v) * params_.step_s * free;
        if (free < rollout.count) {
          // Blocked: kept for braking only, if no sample is admissible.
          const double stop_m = travel_m - 0.5 * v * v / params_.acceleration_mps2;
          if (!best.is_admissible && stop_m > best_stop_m) {
            best_stop_m = stop_m;
            best.v_mps = stop_m > 0.0 ? v : 0.0;
            best.steering = target;
            best.travel_m = travel_m;
          }
          continue;
        }
        // Largest score; of equal ones the first.
        const double calm = std::abs(target.front_rad - state.steering.front_rad) +
                            std::abs(target.rear_rad - state.steering.rear_rad);
        const double score =
            calc_score(judge(rollout, task), params_.cost) - kCalmness_per_rad * calm;
        if (best.is_admissible && score <= best.score) continue;
        best = {v, target, true, score, {}, travel_m};
      }
    }
  }
  // Smallest clearance along the chosen rollout, for the report.
  roll_out(state.pose, best.v_mps, state.steering, best.steering, params_.geometry,
           params_.horizon_s, params_.step_s, &rollout);
  best.clearance = free_space_.measure(outline_, state.pose);
  for (int i = 0; best.is_admissible && i < rollout.count; ++i) {
    const FreeSpace clearance =
        free_space_.measure(outline_, rollout.nodes[i].p, rollout.nodes[i].ahead);
    best.clearance = {std::min(best.clearance.known_m, clearance.known_m),
                      std::min(best.clearance.unknown_m, clearance.unknown_m)};
  }
  return best;
}

}  // namespace vinerow::controllers
