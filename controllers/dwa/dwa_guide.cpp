#include "controllers/dwa/dwa_guide.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.h"

namespace vinerow::controllers {
namespace {

constexpr double kSlow_mps = 0.03;      // slower is stationary
constexpr double kFollowAgain_s = 1.0;  // free for this long: "follows the plan again"
constexpr double kSeenAgain_s = 10.0;   // an obstacle after a longer gap is a new one
constexpr double kMaxClearance_m = 10;  // reported if nothing is near

}  // namespace

DwaGuide::DwaGuide(const DwaGuideParams& params, DiscOutline outline,
                   std::vector<Eigen::Vector2d> outline_B, const DistanceField& known)
    : params_(params),
      outline_B_(std::move(outline_B)),
      free_space_(known, unknown_),
      law_(params.law, std::move(outline), free_space_),
      polygon_(DiscOutline::polygon(outline_B_)),
      plan_(params.plan),
      recovery_(params.recovery),
      stop_(params.law.acceleration_mps2) {
  for (const Eigen::Vector2d& p : outline_B_) {
    front_m_ = std::max(front_m_, p.x());
    half_width_m_ = std::max(half_width_m_, std::abs(p.y()));
  }
}

void DwaGuide::set_plan(const PlannedPath& plan, Time now) {
  plan_.set_plan(plan);
  recovery_.reset(now);
  stop_.reset();
  trace_.clear();
  lane_left_m_ = 0.0;
  is_off_plan_ = false;
  free_since_ = now;
}

bool DwaGuide::take_event(DwaEvent* event) {
  if (event_count_ == 0) return false;
  *event = events_[0];
  std::move(events_.begin() + 1, events_.begin() + event_count_, events_.begin());
  --event_count_;
  return true;
}

void DwaGuide::report_event(DwaEvent::Kind kind, const Eigen::Vector2d& p_W, double distance_m) {
  if (event_count_ < kEventCapacity) events_[event_count_++] = {kind, p_W, distance_m};
}

void DwaGuide::report_obstacles(Time now, const Pose2& pose, const ObstacleMemory& memory) {
  if (memory.obstacles_W().empty()) return;
  if (!has_seen_ || (now - last_seen_).s() > kSeenAgain_s) {
    Eigen::Vector2d nearest = memory.obstacles_W().front();
    for (const Eigen::Vector2d& p : memory.obstacles_W()) {
      if ((p - pose.p).norm() < (nearest - pose.p).norm()) nearest = p;
    }
    report_event(DwaEvent::Kind::kSeen, nearest, (nearest - pose.p).norm());
  }
  has_seen_ = true;
  last_seen_ = now;
}

double DwaGuide::wanted_speed_mps() const {
  const double wanted = plan_.speed_mps() > 0.0 ? plan_.speed_mps() : params_.speed_mps;
  return std::min(wanted, params_.speed_limit_mps);
}

LocalCommand DwaGuide::step(Time now, const DwaState& state, const ObstacleMemory& memory) {
  VINEROW_ASSERT(has_plan());
  unknown_.build(state.pose.p, memory.obstacles_W());
  report_obstacles(now, state.pose, memory);
  plan_.locate(state.pose);
  switch (recovery_.state()) {
    case Recovery::State::kReverse:
      return drive_back(now, state);
    case Recovery::State::kStop:
      recovery_.stand(now, plan_.distance_m());
      return make_stop(state);
    case Recovery::State::kForward:
      break;
  }
  trace_.record(state.pose);
  return drive_forward(now, state, memory);
}

LocalCommand DwaGuide::drive_forward(Time now, const DwaState& state,
                                     const ObstacleMemory& memory) {
  const double acceleration = params_.law.acceleration_mps2;
  const double speed = std::min(wanted_speed_mps(), stop_.update(plan_.distance_m()));
  if (stop_.is_holding()) {
    recovery_.forward(now, plan_.distance_m(), state.v_mps, true, true);
    return make_stop(state);
  }
  const double see_m = speed * params_.law.horizon_s + 0.5 * speed * speed / acceleration;
  const double free_m = plan_.calc_free_m(free_space_, polygon_, state.pose, see_m);
  const bool is_near_end = plan_.remaining_m() <= params_.finish_m;
  // Places beyond the stop may be occupied by other vehicles.
  const bool is_free = free_m >= std::min({see_m, plan_.remaining_m(), stop_.left_m()});
  if (is_free && (params_.mode == DwaMode::kAssist || is_near_end)) {
    lane_left_m_ = 0.0;
    recovery_.forward(now, plan_.distance_m(), state.v_mps, true, true);
    if (is_off_plan_ && !recovery_.is_in_trouble() && (now - free_since_).s() >= kFollowAgain_s) {
      is_off_plan_ = false;
      report_event(DwaEvent::Kind::kFollow, state.pose.p, 0.0);
    }
    return make_follow(state, speed, free_m);
  }
  free_since_ = now;

  const DwaChoice choice = choose_forward(state, memory, speed);
  const bool can_drive = choice.is_admissible && choice.v_mps > kSlow_mps;
  LocalCommand command =
      choice.is_admissible || choice.v_mps > kSlow_mps ? make_drive(choice) : make_stop(state);
  // Follows more slowly, so that it can stop before the obstacle.
  const double late_m = params_.reaction_s * acceleration;
  const double slow_speed =
      std::min(speed, std::sqrt(late_m * late_m + 2.0 * acceleration * free_m) - late_m);
  bool is_following = false;
  if (params_.mode == DwaMode::kAssist && slow_speed > kSlow_mps && lane_left_m_ == 0.0) {
    DwaTask task;
    task.path = &plan_.window();
    task.path_hint = plan_.here();
    task.goal_W = lane_[lane_.index_at(plan_.distance_m() + params_.lookahead_m)].p;
    is_following = !can_drive || calc_follow_score(slow_speed, free_m, task) >= choice.score;
    if (is_following) command = make_follow(state, slow_speed, free_m);
  }
  // A return to the plan is reported only after leaving it or stopping.
  if (params_.mode == DwaMode::kAssist && !is_following) is_off_plan_ = true;
  const Recovery::Change change =
      recovery_.forward(now, plan_.distance_m(), state.v_mps, false, can_drive || is_following);
  if (change == Recovery::Change::kNone) {
    return recovery_.state() == Recovery::State::kForward ? command : make_stop(state);
  }
  const double ahead_m = memory.nearest_ahead_m(state.pose, front_m_, half_width_m_);
  report_event(
      change == Recovery::Change::kReverse ? DwaEvent::Kind::kReverse : DwaEvent::Kind::kBlocked,
      state.pose.p, ahead_m);
  return make_stop(state);
}

DwaChoice DwaGuide::choose_forward(const DwaState& state, const ObstacleMemory& memory,
                                   double speed_mps) {
  // A path beside the plan is searched only past detected obstacles: the planner knows the map.
  if (memory.obstacles_W().empty()) {
    lane_left_m_ = 0.0;
  } else {
    plan_.find_lane(free_space_, law_.outline(), lane_left_m_, &lane_left_m_);
  }
  lane_.copy_moved(plan_.window(), lane_left_m_);
  DwaTask task;
  task.path = &lane_;
  task.path_hint = plan_.here();
  task.goal_W = lane_[lane_.index_at(plan_.distance_m() + params_.lookahead_m)].p;
  task.v_low_mps = 0.0;
  task.v_high_mps = std::min(speed_mps, std::sqrt(2.0 * params_.law.acceleration_mps2 *
                                                  std::max(plan_.remaining_m(), 0.05)));
  task.need = law_.calc_need(state.pose, {params_.plan.margin_m, params_.plan.obstacle_margin_m});
  return law_.choose(state, task);
}

LocalCommand DwaGuide::drive_back(Time now, const DwaState& state) {
  trace_.drive_back(state.pose);
  trace_.copy_back(&back_);
  DwaChoice choice;
  const bool is_rolling_on = state.v_mps > kSlow_mps;
  if (!is_rolling_on && back_.size() >= 2) {
    DwaTask task;
    task.path = &back_;
    task.goal_W = back_[back_.index_at(params_.lookahead_m)].p;
    task.v_low_mps = -params_.reverse_speed_mps;
    task.v_high_mps = 0.0;
    task.need = law_.calc_need(state.pose, {params_.plan.margin_m, params_.plan.obstacle_margin_m});
    choice = law_.choose(state, task);
  }
  const bool can_move = choice.is_admissible && choice.v_mps < -kSlow_mps;
  recovery_.reverse(now, plan_.distance_m(), state.v_mps, can_move || is_rolling_on);
  return can_move ? make_drive(choice) : make_stop(state);
}

double DwaGuide::calc_follow_score(double speed_mps, double free_m, const DwaTask& task) const {
  Rollout rollout;
  const int steps = std::min(
      static_cast<int>(std::ceil(params_.law.horizon_s / params_.law.step_s)), Rollout::kMax);
  for (int i = 0; i < steps; ++i) {
    const Pose2 pose =
        plan_.follow_pose(std::min(speed_mps * params_.law.step_s * (i + 1), free_m));
    rollout.nodes[i] = {pose.p, direction(pose.yaw_rad), pose.yaw_rad};
  }
  rollout.count = steps;
  return calc_score(law_.judge(rollout, task), params_.law.cost);
}

LocalCommand DwaGuide::make_follow(const DwaState& state, double speed_mps, double free_m) const {
  LocalCommand command;
  command.mode = LocalCommand::Mode::kFollow;
  command.v_mps = speed_mps;
  double min_m = free_space_.measure(polygon_, state.pose).min_m();
  for (double s = 0.25; s <= free_m; s += 0.25) {
    min_m = std::min(min_m, free_space_.measure(polygon_, plan_.follow_pose(s)).min_m());
  }
  command.clearance_m = std::min(min_m, kMaxClearance_m);
  return command;
}

LocalCommand DwaGuide::make_drive(const DwaChoice& choice) const {
  LocalCommand command;
  command.mode = LocalCommand::Mode::kDrive;
  command.v_mps = choice.v_mps;
  command.front_axle_rad = choice.steering.front_rad;
  command.rear_axle_rad = choice.steering.rear_rad;
  command.clearance_m = std::min(choice.clearance.min_m(), kMaxClearance_m);
  return command;
}

LocalCommand DwaGuide::make_stop(const DwaState& state) const {
  LocalCommand command;
  command.front_axle_rad = state.steering.front_rad;
  command.rear_axle_rad = state.steering.rear_rad;
  command.clearance_m =
      std::min(free_space_.measure(polygon_, state.pose).min_m(), kMaxClearance_m);
  return command;
}

}  // namespace vinerow::controllers
