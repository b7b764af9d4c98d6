#pragma once
/// Which stretch of its plan a vehicle is on: what metrics share that judge legs and turns apart.
///
/// A point belongs to the nearest segment of the plan's polyline; a segment's kind is that of its
/// first point. Ways to and from the rows are neither leg nor turn.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "engine/api/signal.h"
#include "engine/math/deviation.h"

namespace vinerow {

class PlanStretch {
 public:
  /// Reads "plan" where there is one.
  void connect(Ports& ports);
  /// Takes over a plan that was written since. Plans of fewer than two points are passed over.
  /// @returns whether there is another plan now
  bool take_over();

  bool has_plan() const { return !points_.empty(); }
  const std::vector<PathPoint>& points() const { return points_; }
  double length_m() const { return length_m_; }
  /// The points in the plane. @pre has_plan()
  const PolylineDistance& line() const { return line_; }
  /// Nearest place; looks first where the last call found one. @pre has_plan()
  PolylineDistance::Nearest find(const Eigen::Vector2d& p);
  bool is_leg(int segment) const { return points_[segment].kind == PathKind::kLeg; }
  bool is_turn(int segment) const { return points_[segment].kind == PathKind::kTurn; }

  /// Distance from the planned curve, m: from the arc through the segment's ends with the curvature
  /// that the plan tells of it, because a chord of 0.25 m lies 4.4 mm inside an arc of radius 1.77
  /// m. From the polyline where the segment is straight, its curvature cannot be (chord longer than
  /// the diameter), or the nearest place is a segment's end.
  double curve_distance_m(const PolylineDistance::Nearest& at, const Eigen::Vector2d& p) const;

 private:
  SignalReader<PlannedPath> plan_;
  std::uint64_t plan_seen_ = 0;
  std::vector<PathPoint> points_;
  double length_m_ = 0.0;
  PolylineDistance line_;
  int segment_ = 0;  ///< found last
};

}  // namespace vinerow
