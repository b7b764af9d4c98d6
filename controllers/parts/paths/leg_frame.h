#pragma once
/// Straight leg between two waypoints with along-track distance, cross-track error and height ramp.
///
/// Source: paper A, eq. 1-7, in the form of the reference of paper A, section 2: the distance of
/// eq. 1 with a sign, also on East-West legs, where eq. 2 has no slope; the tolerance of eq. 3 in
/// metres; the foot point of eq. 4-5 with its cosine and sine; the ramp of eq. 6 over the distance
/// along the leg, only inside it. Left of the track is positive (right in the paper, which uses
/// aviation signs).

#include <Eigen/Core>

namespace vinerow::controllers {

/// No heap. Points in W, m.
class LegFrame {
 public:
  LegFrame() = default;
  /// @pre the points differ in plan view
  LegFrame(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W);

  const Eigen::Vector3d& from_W() const { return from_W_; }
  const Eigen::Vector3d& to_W() const { return to_W_; }
  double length_m() const { return length_m_; }      ///< in plan view, L
  double course_rad() const { return course_rad_; }  ///< from east, positive to the left
  double slope() const { return (to_W_.z() - from_W_.z()) / length_m_; }
  /// Unit vectors in plan view.
  const Eigen::Vector2d& along() const { return along_; }
  Eigen::Vector2d left() const { return {-along_.y(), along_.x()}; }

  /// Distance from the leg's start along it, s; negative before it, more than L beyond.
  double along_m(const Eigen::Vector2d& p) const;
  /// Distance to the left of the leg's line: -e of the reference; |e| is that of eq. 1.
  double left_m(const Eigen::Vector2d& p) const;
  /// The nearest point of the leg's line (eq. 4-5).
  Eigen::Vector2d foot(const Eigen::Vector2d& p) const;
  /// Height of the ramp at s, held before and beyond the leg (eq. 6).
  double height_m(double along_m) const;
  /// Climb angle of the ramp at s, rad: zero before and beyond the leg.
  double climb_rad(double along_m) const;

 private:
  Eigen::Vector3d from_W_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_W_ = Eigen::Vector3d::UnitX();
  Eigen::Vector2d along_ = Eigen::Vector2d::UnitX();
  double length_m_ = 1.0;
  double course_rad_ = 0.0;
};

/// Cross-track tolerance of eq. 3 in metres: max(least, most (1 - s/L)).
double calc_cross_track_tolerance_m(double share_of_leg, double max_m, double min_m);

}  // namespace vinerow::controllers
