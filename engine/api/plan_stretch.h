#pragma once
/// Which stretch of its plan a vehicle is on: what metrics share that judge legs and turns apart,
/// and sensors that work on the legs only.
///
/// A point belongs to the nearest segment of the plan's polyline; a segment's kind is that of its
/// first point. Ways to and from the rows are neither leg nor turn.
///
/// Nearest means in the plane, because a plan on the ground and a body's origin differ in height.
/// Of a flight (a plan with a stretch that is vertical or leads home) it means in space: its way
/// home crosses above its legs, and take-off and landing are one point in the plane.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "engine/api/messages/path.h"
#include "engine/api/signal.h"
#include "engine/math/deviation.h"

namespace vinerow {

class PlanStretch {
 public:
  /// Where a point is on the plan.
  struct Place {
    int segment = 0;
    double fraction = 0.0;    ///< 0..1 along the segment, in the plane
    double distance_m = 0.0;  ///< from the polyline: in the plane, of a flight in space
    double lateral_m = 0.0;   ///< from the segment in the plane, not negative
    double plan_z_m = 0.0;    ///< height of the plan there, in W
  };

  /// Reads "plan" where there is one.
  void connect(Ports& ports);
  /// Takes over a plan that was written since. Plans of fewer than two points are passed over.
  /// @returns whether there is another plan now
  bool take_over();
  /// Takes over a plan from elsewhere, e.g. from a log. @returns as take_over()
  bool take_over(const PlannedPath& plan);

  bool has_plan() const { return !points_.empty(); }
  /// It has a stretch that is vertical or leads home: its heights are those of a flight.
  bool is_flight() const { return flight_.has_value(); }
  const std::vector<PathPoint>& points() const { return points_; }
  double length_m() const { return length_m_; }
  /// The points in the plane. @pre has_plan()
  const PolylineDistance& line() const { return line_; }
  /// Nearest place; looks first where the last call found one. No heap. @pre has_plan()
  Place find(const Eigen::Vector3d& p_W);
  bool is(PathKind kind, int segment) const { return points_[segment].kind == kind; }
  bool is_leg(int segment) const { return is(PathKind::kLeg, segment); }
  bool is_turn(int segment) const { return is(PathKind::kTurn, segment); }
  /// The lane that is flown or driven: the alley of the leg at the nearest place, 0 where a leg
  /// tells none; -1 off the legs, and where the way leads more than 60 degrees off the leg's
  /// direction (a way home across the lanes is on none of them). No heap.
  /// @param v_W  velocity over ground, m/s; slower than 0.1 m/s has no direction
  int lane(const Eigen::Vector3d& p_W, const Eigen::Vector3d& v_W);
  /// Rises or falls more than it leads on, as at both ends of a way home.
  bool is_steep(int segment) const;

  /// Distance from the planned curve in the plane, m: from the arc through the segment's ends with
  /// the curvature that the plan tells of it, because a chord of 0.25 m lies 4.4 mm inside an arc
  /// of radius 1.77 m. From the segment where it is straight, its curvature cannot be (chord longer
  /// than the diameter), or the nearest place is one of its ends.
  double curve_distance_m(const Place& at, const Eigen::Vector2d& p) const;

 private:
  SignalReader<PlannedPath> plan_;
  std::uint64_t plan_seen_ = 0;
  std::vector<PathPoint> points_;
  double length_m_ = 0.0;
  PolylineDistance line_;
  std::optional<SpacePolylineDistance> flight_;
  int segment_ = 0;  ///< found last
};

}  // namespace vinerow
