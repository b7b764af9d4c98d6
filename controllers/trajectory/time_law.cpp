#include "controllers/trajectory/time_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "controllers/parts/paths/box_filter.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

// Plan. The run is a curve p(s) with yaw(s) over its distance s; a speed here is v = ds/dt.
//   1. limit_speeds(), at each knot the smallest of
//        |p'| v <= wanted speed,       p'_z v <= climb, -p'_z v <= descent,
//        |p''_n| v^2 <= lateral acceleration, p''_n the part of p'' normal to the path,
//        |yaw'| v <= yaw rate,         |yaw''| v^2 <= yaw acceleration,
//      `stretch` = |p'|, `bend` = |p''_n|, `turn` = |yaw'|, `change` = |yaw''|.
//   2. limit_acceleration(), forwards and backwards over the knots, ds apart:
//        v_i^2 <= v_{i-1}^2 + 2 a ds,  v_i^2 <= v_{i+1}^2 + 2 a ds,  v = 0 at both ends.
//   3. widen(): the average over ease_s in step 5 mixes speeds from ease_s / 2 before and after, so
//      each limit of step 1 also applies to the distance v ease_s / 2 around its knot. Then step 2
//      again.
//   4. sample_distances(): s(t) every kStep_s, with constant acceleration between knots.
//   5. Moving average of s(t) over ease_s, then a spline through it.

// Sampling time of s(t). Chosen: 25 samples within the default ease_s of 0.5 s.
constexpr double kStep_s = 0.02;
// Share of the limits that is used. Chosen: a reserve for places between knots and for the average.
constexpr double kReserve = 0.97;
// Derivatives below this are zero, up to rounding, and limit nothing.
constexpr double kTiny = 1e-9;
// Longest duration of a run. Chosen: 10 million samples.
constexpr double kLongest_s = 2e5;
// Accuracy of time_of(). Chosen far below kStep_s.
constexpr double kTimeTolerance_s = 1e-6;

double wanted_speed_mps(PathKind kind, const TrajectoryLimits& limits) {
  switch (kind) {
    case PathKind::kLeg:
    case PathKind::kTurn:
      return limits.row_speed_mps;
    case PathKind::kReturn:
      return limits.return_speed_mps;
    case PathKind::kTransit:
    case PathKind::kVertical:
      break;
  }
  return limits.transit_speed_mps;
}

/// Largest ds/dt that every limit allows, at the knots.
std::vector<double> limit_speeds(const SmoothRun& run, const TrajectoryLimits& limits,
                                 double slow_from_m) {
  std::vector<double> max_speeds;
  max_speeds.reserve(run.knots());
  for (int i = 0; i < run.knots(); ++i) {
    const double at_m = i * run.step_m();
    const SmoothRun::Sample on = run.at(at_m);
    const double stretch = on.first.norm();
    double speed = run.is_vertical() ? std::numeric_limits<double>::infinity()
                                     : wanted_speed_mps(run.kind(i), limits) / stretch;
    if (run.speed_mps(i) > 0.0) speed = std::min(speed, run.speed_mps(i) / stretch);
    const double slope = on.first.z();
    if (slope > kTiny) speed = std::min(speed, limits.climb_speed_mps / slope);
    if (slope < -kTiny) speed = std::min(speed, limits.descent_speed_mps / -slope);
    const Eigen::Vector3d along = on.first / stretch;
    const double bend = (on.second - on.second.dot(along) * along).norm();
    if (bend > kTiny) {
      speed = std::min(speed, std::sqrt(kReserve * limits.lateral_acceleration_mps2 / bend));
    }
    const double turn = std::abs(on.yaw_per_m);
    if (turn > kTiny) speed = std::min(speed, kReserve * limits.yaw_rate_radps / turn);
    const double before = run.at(at_m - run.step_m()).yaw_per_m;
    const double after = run.at(at_m + run.step_m()).yaw_per_m;
    // At the ends the neighbour is the knot itself: half the step, twice the change.
    const bool is_end = i == 0 || i + 1 == run.knots();
    const double change = std::abs(after - before) / ((is_end ? 1.0 : 2.0) * run.step_m());
    if (change > kTiny) {
      speed = std::min(speed, std::sqrt(kReserve * limits.yaw_acceleration_radps2 / change));
    }
    if (at_m >= slow_from_m) speed = std::min(speed, limits.landing_speed_mps / stretch);
    max_speeds.push_back(speed);
  }
  return max_speeds;
}

/// Forwards, then backwards: v dv/ds is at most the acceleration; from rest to rest.
std::vector<double> limit_acceleration(std::vector<double> speeds, double step_m,
                                       double acceleration_mps2) {
  const double gain = 2.0 * kReserve * acceleration_mps2 * step_m;
  speeds.front() = speeds.back() = 0.0;
  for (std::size_t i = 1; i < speeds.size(); ++i) {
    speeds[i] = std::min(speeds[i], std::sqrt(speeds[i - 1] * speeds[i - 1] + gain));
  }
  for (std::size_t i = speeds.size() - 1; i-- > 0;) {
    speeds[i] = std::min(speeds[i], std::sqrt(speeds[i + 1] * speeds[i + 1] + gain));
  }
  return speeds;
}

/// Extends every limit around its knot as far as the average over ease_s mixes speeds.
std::vector<double> widen(const std::vector<double>& max_speeds, const std::vector<double>& flown,
                          double step_m, double ease_s) {
  std::vector<double> widened = max_speeds;
  const int last = static_cast<int>(max_speeds.size()) - 1;
  for (int i = 0; i <= last; ++i) {
    const int reach = static_cast<int>(std::ceil(0.5 * ease_s * flown[i] / step_m)) + 1;
    for (int k = std::max(0, i - reach); k <= std::min(last, i + reach); ++k) {
      widened[i] = std::min(widened[i], max_speeds[k]);
    }
  }
  return widened;
}

/// Tiny limits would make a flight of years, sampled every kStep_s.
void check_duration(const std::vector<double>& speeds, double step_m) {
  double duration_s = 0.0;
  for (std::size_t i = 0; i + 1 < speeds.size(); ++i) {
    duration_s += 2.0 * step_m / (speeds[i] + speeds[i + 1]);
  }
  if (duration_s <= kLongest_s) return;
  throw ConfigError(fmt::format(
      "a stretch of {:.0f} m would take {:.3g} h within the limits of the trajectory, at most "
      "{:.0f} "
      "h are planned: raise its speeds, accelerations and yaw rates",
      static_cast<double>(speeds.size() - 1) * step_m, duration_s / 3600.0, kLongest_s / 3600.0));
}

/// Distances at even times, with constant acceleration between two knots.
std::vector<double> sample_distances(const std::vector<double>& speeds, double step_m,
                                     double before_s) {
  std::vector<double> distances_m;
  double knot_s = before_s;  // when the knot i is passed
  const double longest_m = static_cast<double>(speeds.size() - 1) * step_m;
  double time_s = 0.0;
  const auto next = [&](double distance_m) {
    distances_m.push_back(std::min(distance_m, longest_m));
    time_s = kStep_s * static_cast<double>(distances_m.size());
  };
  while (time_s < before_s) next(0.0);
  for (std::size_t i = 0; i + 1 < speeds.size(); ++i) {
    const double v = speeds[i], w = speeds[i + 1];
    const double lasts_s = 2.0 * step_m / (v + w);
    const double start_m = static_cast<double>(i) * step_m;
    while (time_s < knot_s + lasts_s) {
      const double t = time_s - knot_s;
      next(start_m + v * t + 0.5 * (w - v) / lasts_s * t * t);
    }
    knot_s += lasts_s;
  }
  const int after = static_cast<int>(std::ceil(before_s / kStep_s)) + 1;
  for (int k = 0; k < after; ++k) next(longest_m);
  return distances_m;
}

}  // namespace

TimeLaw::TimeLaw(const SmoothRun& run, const TrajectoryLimits& limits, double slow_from_m) {
  const std::vector<double> max_speeds = limit_speeds(run, limits, slow_from_m);
  const double step_m = run.step_m();
  std::vector<double> speeds = limit_acceleration(max_speeds, step_m, limits.acceleration_mps2);
  speeds = limit_acceleration(widen(max_speeds, speeds, step_m, limits.ease_s), step_m,
                              limits.acceleration_mps2);
  check_duration(speeds, step_m);
  const int half = calc_half_window(limits.ease_s, kStep_s);
  // Rest before and after, for the window of the average and for the spline's own three points.
  const double rest_s = (half + 3) * kStep_s;
  std::vector<double> distances_m = sample_distances(speeds, step_m, rest_s);
  distances_m = smooth_box(distances_m, half, Beyond::kConstant);
  spline_ = UniformSpline<double>(kStep_s, distances_m);
}

double TimeLaw::time_of(double distance_m) const {
  double low_s = 0.0, high_s = duration_s();
  while (high_s - low_s > kTimeTolerance_s) {
    const double middle_s = 0.5 * (low_s + high_s);
    (at(middle_s).value < distance_m ? low_s : high_s) = middle_s;
  }
  return high_s;
}

}  // namespace vinerow::controllers
