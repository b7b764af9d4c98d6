#include "controllers/path_follower/path_follower_law.h"

#include <algorithm>
#include <cmath>

#include "controllers/parts/paths/path_corners.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

// The law of path_follower_law.h as computed in calc_yaw_rate():
//   damping  = 2 zeta / L,  approach = (e + integral) / (L^2 damping), clamped
//   feedback = -damping (sin(psi) + approach) = -(2 zeta / L) sin(psi) - (e + integral) / L^2
//   w        = v feed_forward + max(v, kPivot_mps) feedback
// feed_forward is the mean of kappa_ref over the distance of the coming cycle. With a slide arm the
// wanted heading leads the path's by arm smoothed, where `smoothed` is the mean of kappa_ref over
// [-h, h] about the place; the derivative of that lead along the path,
//   arm (kappa_ref(+h) - kappa_ref(-h)) / (2 h),
// is added to the feed-forward.

// Window along the path in which the place is searched each cycle. Chosen: a noisy position may be
// behind the last one, and another pass of the path must stay outside.
constexpr double kSearchBehind_m = 0.5;
constexpr double kSearchAhead_m = 1.0;
// The same for a vehicle that has just received its path. Chosen.
constexpr double kFirstSearch_m = 3.0;
// Sine of the angle at which a distant path is approached. Chosen: 53 deg.
constexpr double kSteepestApproach = 0.8;
// Turn on the spot: yaw rate per heading error. Chosen.
constexpr double kSpotGain_per_s = 2.0;
// Heading error at which the turn on the spot ends and the law takes over: 5 deg. Chosen.
constexpr double kTurned_rad = 0.087;
// Smallest share of the wanted speed at a large heading error. Chosen: the vehicle must not stop.
constexpr double kMinSpeedShare = 0.1;
// Deceleration of the command, in units of the planned one. Chosen: unplanned braking may be
// harder.
constexpr double kBrakingShare = 2.0;
// Smallest distance of a cycle for means along the path: no division by zero at rest.
constexpr double kMinCycle_m = 1e-3;
// Lateral errors up to this many integral_max_m are integrated. Chosen.
constexpr double kIntegralZone = 2.0;
// Speed below which the feedback turns the vehicle as at this speed. Chosen: it need not roll to
// correct its heading.
constexpr double kPivot_mps = 0.3;
}  // namespace

void PathFollowerLaw::set_path(const PlannedPath& plan) {
  path_ = Path(plan);
  has_path_ = true;
  finished_ = path_.empty();
  state_ = {};
  state_.finished = finished_;
  state_.remaining_m = path_.length_m();
  integral_m_ = 0.0;
  distance_m_ = -1.0;
  stop_.reset();
  corners_m_.clear();
  corners_passed_ = 0;
  is_turning_ = false;
  for (int i = 1; i < path_.segment_count(); ++i) {
    if (std::abs(path_.jump_at(i)) > kSharpCorner_rad) corners_m_.push_back(path_.start_of(i));
  }
  if (!path_.empty()) profile_ = SpeedProfile(path_, params_.speed);
}

double PathFollowerLaw::calc_lookahead_m(double speed_mps) const {
  return std::clamp(params_.lookahead_s * speed_mps, params_.lookahead_min_m,
                    params_.lookahead_max_m);
}

double PathFollowerLaw::calc_speed(const Path::Nearest& at, double heading_error_rad) {
  // The profile here and settle_m ahead, so that braking for a turn is over before it.
  double wanted = profile_.speed_at(path_, at.segment, at.distance_m);
  const double ahead_m = at.distance_m + params_.settle_m;
  if (ahead_m < std::min(path_.length_m(), stretch_end_m())) {
    const int segment = path_.segment_at(ahead_m, at.segment);
    wanted = std::min(wanted, profile_.speed_at(path_, segment, ahead_m));
  }
  // Turn before driving off in a wrong direction.
  wanted *= std::max(std::cos(heading_error_rad), kMinSpeedShare);
  wanted = std::min(wanted, stop_.update(at.distance_m));
  const double step = params_.speed.acceleration_mps2 * params_.cycle_s;
  return std::clamp(wanted, std::max(speed_mps_ - kBrakingShare * step, 0.0), speed_mps_ + step);
}

double PathFollowerLaw::calc_yaw_rate(const Path::Nearest& at, double heading_error_rad,
                                      const Sideslip& slide, double speed_mps) {
  const double travel_m = std::max(speed_mps * params_.cycle_s, kMinCycle_m);
  const double from_m = at.distance_m + speed_mps * params_.response_s;
  double feed_forward = path_.turn_between_rad(from_m, from_m + travel_m, at.segment) / travel_m;
  double course_error = heading_error_rad;
  if (slide.arm_m != 0.0 || slide.drift_rad != 0.0) {
    // The wanted lead of the heading, and its derivative along the path.
    const double h = params_.smoothing_m;
    const double before_m = std::max(from_m - h, 0.0), after_m = from_m + h;
    const double smoothed = path_.turn_between_rad(before_m, after_m, at.segment) / (2.0 * h);
    course_error = wrap_angle(heading_error_rad - slide.arm_m * smoothed + slide.drift_rad);
    feed_forward +=
        slide.arm_m *
        (path_.curvature_at(after_m, at.segment) - path_.curvature_at(before_m, at.segment)) /
        (2.0 * h);
  }

  const double lookahead = calc_lookahead_m(speed_mps);
  const double damping = 2.0 * params_.damping / lookahead;
  const double e = at.lateral_error_m;
  if (params_.integral > 0.0) {
    // Integrate only near the path: the return from a large error contains no information on drift.
    if (std::abs(e) < kIntegralZone * params_.integral_max_m) {
      integral_m_ += params_.integral * e * travel_m / lookahead;
    }
    integral_m_ = std::clamp(integral_m_, -params_.integral_max_m, params_.integral_max_m);
  }
  const double approach = std::clamp((e + integral_m_) / (lookahead * lookahead * damping),
                                     -kSteepestApproach, kSteepestApproach);
  // Beyond a quarter turn the sine falls again, but the vehicle must not turn more slowly.
  const double sine = std::abs(course_error) > 0.5 * kPi ? std::copysign(1.0, course_error)
                                                         : std::sin(course_error);
  const double feedback = std::clamp(-damping * (sine + approach), -params_.max_curvature_per_m,
                                     params_.max_curvature_per_m);
  return std::clamp(speed_mps * feed_forward + std::max(speed_mps, kPivot_mps) * feedback,
                    -params_.yaw_rate_max_radps, params_.yaw_rate_max_radps);
}

Path::Nearest PathFollowerLaw::find_place(const Pose2& pose) const {
  const bool is_first = distance_m_ < 0.0;
  const double from_m = is_first ? 0.0 : distance_m_ - kSearchBehind_m;
  const double to_m = is_first ? kFirstSearch_m : distance_m_ + kSearchAhead_m;
  // The corner itself belongs to the next stretch.
  const double before_corner_m = std::nextafter(stretch_end_m(), 0.0);
  return path_.nearest(pose.p, std::max(from_m, stretch_start_m()), std::min(to_m, before_corner_m),
                       state_.waypoint);
}

VelocityCommand PathFollowerLaw::turn_on_the_spot(const Path::Nearest& at,
                                                  double heading_error_rad) {
  is_turning_ = std::abs(heading_error_rad) > kTurned_rad;
  const bool may_go = stop_.update(at.distance_m) > 0.0;
  speed_mps_ =
      std::max(speed_mps_ - kBrakingShare * params_.speed.acceleration_mps2 * params_.cycle_s, 0.0);
  if (!may_go) return {speed_mps_, 0.0};
  const double max_radps = std::min(params_.speed.yaw_rate_radps, params_.yaw_rate_max_radps);
  return {speed_mps_, std::clamp(-kSpotGain_per_s * heading_error_rad, -max_radps, max_radps)};
}

VelocityCommand PathFollowerLaw::step(const Pose2& pose, const Sideslip& slide,
                                      double overspeed_mps) {
  if (!has_path_ || finished_) {
    speed_mps_ = 0.0;
    return {};
  }
  Path::Nearest at = find_place(pose);
  // End of the stretch before a sharp corner: continue with the next stretch, turning first.
  if (stretch_end_m() - at.distance_m < params_.goal_tolerance_m) {
    distance_m_ = stretch_end_m();
    ++corners_passed_;
    is_turning_ = true;
    integral_m_ = 0.0;
    at = find_place(pose);
  }
  const double heading_error = wrap_angle(pose.yaw_rad - at.yaw_rad);
  distance_m_ = at.distance_m;

  state_.lateral_error_m = at.lateral_error_m;
  state_.heading_error_rad = heading_error;
  state_.distance_m = at.distance_m;
  state_.remaining_m = path_.length_m() - at.distance_m;
  state_.waypoint = at.segment;
  finished_ = state_.remaining_m < params_.goal_tolerance_m;
  state_.finished = finished_;
  if (finished_) {
    speed_mps_ = 0.0;
    return {};
  }
  if (is_turning_) return turn_on_the_spot(at, heading_error);
  speed_mps_ = calc_speed(at, heading_error);
  if (stop_.is_holding() && speed_mps_ == 0.0) return {};
  // The curvature is driven with the actual speed, not the wanted one.
  const double speed = std::max(speed_mps_ + overspeed_mps, 0.0);
  return {speed_mps_, calc_yaw_rate(at, heading_error, slide, speed)};
}

}  // namespace vinerow::controllers
