#include "controllers/parts/paths/leg_frame.h"

#include <algorithm>
#include <cmath>

#include "engine/core/check.h"

namespace vinerow::controllers {

LegFrame::LegFrame(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W)
    : from_W_(from_W), to_W_(to_W) {
  const Eigen::Vector2d chord = (to_W - from_W).head<2>();
  length_m_ = chord.norm();
  VINEROW_ASSERT(length_m_ > 0.0);
  along_ = chord / length_m_;
  course_rad_ = std::atan2(along_.y(), along_.x());
}

double LegFrame::along_m(const Eigen::Vector2d& p) const {
  return along_.dot(p - from_W_.head<2>());
}

double LegFrame::left_m(const Eigen::Vector2d& p) const {
  return left().dot(p - from_W_.head<2>());
}

Eigen::Vector2d LegFrame::foot(const Eigen::Vector2d& p) const {
  return p - left_m(p) * left();
}

double LegFrame::height_m(double along_m) const {
  const double share = std::clamp(along_m / length_m_, 0.0, 1.0);
  return from_W_.z() + (to_W_.z() - from_W_.z()) * share;
}

double LegFrame::climb_rad(double along_m) const {
  return along_m < 0.0 || along_m > length_m_ ? 0.0 : std::atan(slope());
}

double calc_cross_track_tolerance_m(double share_of_leg, double max_m, double min_m) {
  return std::max(min_m, max_m * (1.0 - share_of_leg));
}

}  // namespace vinerow::controllers
