#include "controllers/dwa/recovery.h"

#include <algorithm>
#include <cmath>

namespace vinerow::controllers {
namespace {
constexpr double kStationary_mps = 0.05;
// Number of recent poses among which the nearest one is searched.
constexpr int kSearch = 20;
}  // namespace

void DrivenTrace::record(const Pose2& pose) {
  if (count_ > 0 && (pose.p - poses_[count_ - 1].p).norm() < kPitch_m) return;
  if (count_ == kCapacity) {
    std::move(poses_.begin() + 1, poses_.end(), poses_.begin());
    --count_;
  }
  poses_[count_++] = pose;
}

void DrivenTrace::drive_back(const Pose2& pose) {
  int nearest = count_ - 1;
  for (int i = count_ - 1; i >= std::max(count_ - kSearch, 0); --i) {
    if ((poses_[i].p - pose.p).norm() < (poses_[nearest].p - pose.p).norm()) nearest = i;
  }
  count_ = nearest + 1;
}

void DrivenTrace::copy_back(LocalPath* path) const {
  path->clear();
  for (int i = count_ - 1; i >= 0; --i) path->add(poses_[i], (count_ - 1 - i) * kPitch_m);
}

void Recovery::reset(Time now) {
  *this = Recovery(params_);
  progress_ = moving_ = now;
}

void Recovery::try_again(Time now, double distance_m) {
  state_ = State::kForward;
  is_reversing_ = false;
  progress_m_ = distance_m;
  progress_ = moving_ = now;
}

Recovery::Change Recovery::forward(Time now, double distance_m, double v_mps, bool is_free,
                                   bool can_move) {
  if (is_in_trouble() && distance_m > jam_m_ + params_.past_m) {
    recoveries_ = tries_ = 0;
    is_looking_back_ = false;
    is_reported_ = false;
  }
  if (is_free || distance_m > progress_m_ + params_.progress_m) {
    progress_m_ = distance_m;
    progress_ = now;
  }
  if (is_free || can_move || std::abs(v_mps) > kStationary_mps) moving_ = now;
  const bool is_jammed =
      (now - progress_).s() > params_.stall_s || (now - moving_).s() > params_.stopped_s;
  if (!is_jammed) return Change::kNone;
  jam_m_ = is_in_trouble() ? std::max(jam_m_, distance_m) : distance_m;
  if (recoveries_ < params_.max_recoveries) {
    ++recoveries_;
    ++reversals_;
    state_ = State::kReverse;
    is_reversing_ = false;
    until_ = now + duration_from_s(reverse_time_s());
    return is_reported_ ? Change::kNone : Change::kReverse;
  }
  state_ = State::kStop;
  until_ = now + duration_from_s(params_.retry_s);
  const bool is_new_event = !is_reported_;
  is_reported_ = true;
  return is_new_event ? Change::kStop : Change::kNone;
}

void Recovery::reverse(Time now, double distance_m, double v_mps, bool can_move) {
  if (!is_reversing_ && v_mps < kStationary_mps) {
    // The time counts from the stop.
    is_reversing_ = true;
    until_ = now + duration_from_s(reverse_time_s());
  }
  if (!can_move || now >= until_) try_again(now, distance_m);
}

void Recovery::stand(Time now, double distance_m) {
  if (now < until_) return;
  is_looking_back_ = ++tries_ % kLookBack == 0;
  if (is_looking_back_) recoveries_ = std::max(params_.max_recoveries - 1, 0);
  try_again(now, distance_m);
}

}  // namespace vinerow::controllers
