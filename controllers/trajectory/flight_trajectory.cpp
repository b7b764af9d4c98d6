#include "controllers/trajectory/flight_trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

// Height above the ground at which the vehicle starts to turn.
constexpr double kTurnAbove_m = 0.3;

ReferenceTrajectory::Phase phase_of_kind(PathKind kind) {
  switch (kind) {
    case PathKind::kLeg:
      return ReferenceTrajectory::Phase::kRow;
    case PathKind::kTurn:
      return ReferenceTrajectory::Phase::kTurn;
    case PathKind::kReturn:
      return ReferenceTrajectory::Phase::kReturn;
    case PathKind::kTransit:
    case PathKind::kVertical:
      break;
  }
  return ReferenceTrajectory::Phase::kTransit;
}

/// Continues a landing below the plan's end, for the detection of the touchdown.
void extend_landing(std::vector<CurveRun>& runs, double by_m) {
  CurveRun& last = runs.back();
  if (!last.is_vertical || last.pieces.back().rise_m >= 0.0) return;
  CurveSegment piece = last.pieces.back();
  piece.start_height_m += piece.rise_m;
  piece.rise_m = -by_m;
  piece.plan_length_m = 0.0;
  piece.length_m = by_m;
  last.pieces.push_back(piece);
  last.length_m += by_m;
}

/// Runs are sampled every few centimetres.
void check_length(double run_m) {
  constexpr double kLongest_m = 1e5;
  if (run_m <= kLongest_m) return;
  throw ConfigError(
      fmt::format("a stretch of {:.0f} m of the plan is too long for a flight, must be at most "
                  "{:.0f} km: lower its heights, or bring its places nearer",
                  run_m, kLongest_m / 1e3));
}

bool is_descent(const CurveRun& run) {
  return run.is_vertical && run.pieces.back().rise_m < 0.0;
}

}  // namespace

FlightTrajectory::FlightTrajectory(const PlannedPath& plan, double yaw_rad,
                                   const FlightOptions& options) {
  std::vector<CurveRun> curve = make_curve_runs(plan, options.sharp_rad);
  if (curve.empty()) return;
  for (const CurveRun& run : curve) {
    length_m_ += run.length_m;
    check_length(run.length_m);
  }
  end_height_m_ = plan.points.back().p_W.z();
  landing_mps_ = options.limits.landing_speed_mps;
  const bool lands = is_descent(curve.back());
  if (lands && options.landing_reserve_m > 0.0) extend_landing(curve, options.landing_reserve_m);

  const int count = static_cast<int>(curve.size());
  runs_.reserve(count);
  laws_.reserve(count);
  for (int i = 0; i < count; ++i) {
    runs_.emplace_back(curve[i], options.limits.blend_m);
    const bool is_landing = lands && i + 1 == count;
    const double slow_from_m =
        is_landing ? curve[i].length_m - options.landing_reserve_m - options.limits.landing_zone_m
                   : std::numeric_limits<double>::infinity();
    laws_.emplace_back(runs_[i], options.limits, slow_from_m);
  }

  yaw_ = {0.0, 0.0, yaw_rad, 0.0};
  p_W_ = runs_.front().at(0.0).p_W;
  add_rest(options.spin_up_s, runs_.front().is_vertical() ? Phase::kTakeOff : Phase::kTransit);
  for (int i = 0; i < count; ++i) {
    if (options.hold && i + 1 == count) {
      if (options.hold->yaw_rad) {
        yaw_ = make_yaw_move(now_s_, yaw_.end_rad(), *options.hold->yaw_rad,
                             options.limits.yaw_rate_radps, options.limits.yaw_acceleration_radps2);
        add_rest(yaw_.duration_s, Phase::kHover);
      }
      add_rest(options.hold->duration_s, Phase::kHover);
    }
    std::optional<double> next_yaw_rad;
    for (int k = i; k < count && !next_yaw_rad; ++k) {
      if (!runs_[k].is_vertical()) next_yaw_rad = runs_[k].start_yaw_rad();
    }
    add_run(i, i == 0, i + 1 == count, next_yaw_rad, options);
  }
}

void FlightTrajectory::add_rest(double duration_s, Phase phase) {
  if (duration_s <= 0.0) return;
  Stage stage;
  stage.start_s = now_s_;
  stage.end_s = now_s_ + duration_s;
  stage.yaw = yaw_;
  stage.p_W = p_W_;
  stage.phase = phase;
  stage.start_m = now_m_;
  stages_.push_back(stage);
  now_s_ = stage.end_s;
}

/// @param next_yaw_rad  direction of the first run that is not vertical, this one or a later one
void FlightTrajectory::add_run(int run, bool is_first, bool is_last,
                               std::optional<double> next_yaw_rad, const FlightOptions& options) {
  const SmoothRun& curve = runs_[run];
  const TimeLaw& law = laws_[run];
  const TrajectoryLimits& limits = options.limits;
  Stage stage;
  stage.run = run;
  stage.start_m = now_m_;
  stage.follows = !curve.is_vertical();
  const bool goes_down = curve.at(0.0).first.z() < 0.0;
  stage.phase = Phase::kTransit;
  if (curve.is_vertical()) {
    if (is_first) stage.phase = Phase::kTakeOff;
    if (!is_first && has_flown_rows_) stage.phase = Phase::kReturn;
    if (is_last && goes_down) stage.phase = Phase::kLand;
  }
  // Turns on the spot before a run, or during a vertical run.
  const double before_s = stage.follows ? 0.0 : law.time_of(is_first ? kTurnAbove_m : 0.0);
  if (next_yaw_rad) {
    yaw_ = make_yaw_move(now_s_ + before_s, yaw_.end_rad(), *next_yaw_rad, limits.yaw_rate_radps,
                         limits.yaw_acceleration_radps2);
  }
  if (stage.follows) {
    add_rest(yaw_.end_s() - now_s_, phase_of_kind(curve.kind(0)));
    stage.yaw_shift_rad = yaw_.end_rad() - curve.start_yaw_rad();
  }
  stage.start_s = now_s_;
  stage.end_s = now_s_ + law.duration_s();
  stage.yaw = yaw_;
  stages_.push_back(stage);
  now_s_ = stage.end_s;
  now_m_ += curve.length_m();
  p_W_ = curve.at(curve.length_m()).p_W;
  if (stage.follows) {
    yaw_ = {now_s_, 0.0, curve.end_yaw_rad() + stage.yaw_shift_rad, 0.0};
    for (int i = 0; i < curve.knots(); ++i) {
      has_flown_rows_ = has_flown_rows_ || curve.kind(i) == PathKind::kLeg;
    }
  } else {
    add_rest(yaw_.end_s() - now_s_, stage.phase);
  }
}

FlightTrajectory::Phase FlightTrajectory::phase_of(const Stage& stage, double along_m) const {
  if (stage.run < 0 || runs_[stage.run].is_vertical()) return stage.phase;
  return phase_of_kind(runs_[stage.run].kind_at(along_m));
}

FlightTrajectory::Sample FlightTrajectory::at(double time_s) const {
  Sample sample = find(time_s);
  const double after_s = time_s - duration_s();
  if (sample.phase == Phase::kLand && after_s > 0.0) {
    sample.point.p_W.z() -= landing_mps_ * after_s;
    sample.point.v_W.z() = -landing_mps_;
  }
  return sample;
}

FlightTrajectory::Sample FlightTrajectory::find(double time_s) const {
  const auto next = std::upper_bound(stages_.begin(), stages_.end(), time_s,
                                     [](double t, const Stage& stage) { return t < stage.end_s; });
  const Stage& stage = next == stages_.end() ? stages_.back() : *next;
  const double in_s = std::clamp(time_s, stage.start_s, stage.end_s) - stage.start_s;
  Sample sample;
  TrajectoryPoint& point = sample.point;
  const YawMove::Sample turn = stage.yaw.at(stage.start_s + in_s);
  point.yaw_rad = turn.yaw_rad;
  point.yaw_rate_radps = turn.rate_radps;
  if (stage.run < 0) {
    point.p_W = stage.p_W;
    sample.phase = stage.phase;
    sample.distance_m = stage.start_m;
    return sample;
  }
  const auto along = laws_[stage.run].at(in_s);
  const SmoothRun::Sample on = runs_[stage.run].at(along.value);
  point.p_W = on.p_W;
  point.v_W = on.first * along.first;
  point.a_W = on.second * (along.first * along.first) + on.first * along.second;
  if (stage.follows) {
    point.yaw_rad = on.yaw_rad + stage.yaw_shift_rad;
    point.yaw_rate_radps = on.yaw_per_m * along.first;
  }
  sample.phase = phase_of(stage, along.value);
  sample.distance_m = std::min(stage.start_m + along.value, length_m_);
  return sample;
}

double FlightTrajectory::time_of(double distance_m) const {
  if (distance_m <= 0.0) return 0.0;
  // A hold may last forever; no distance is reached after its start.
  double low_s = 0.0, high_s = 0.0;
  for (const Stage& stage : stages_) {
    if (std::isinf(stage.end_s)) break;
    high_s = stage.end_s;
  }
  while (high_s - low_s > 1e-6) {
    const double middle_s = 0.5 * (low_s + high_s);
    (at(middle_s).distance_m < distance_m ? low_s : high_s) = middle_s;
  }
  return high_s;
}

}  // namespace vinerow::controllers
