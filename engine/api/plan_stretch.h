#pragma once
/// Position of a vehicle on its plan, for metrics that judge legs and turns apart and for sensors
/// that work only on legs.
///
/// A point belongs to the nearest segment of the plan's polyline; a segment has the kind of its
/// first point. Paths to and from the rows are neither leg nor turn.
///
/// The distance is measured in the plane, because a plan on the ground and a body's origin differ
/// in height. For a flight (a plan with a stretch that is vertical or returns home) it is measured
/// in space: the return path crosses above the legs, and take-off and landing are one point in the
/// plane.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "engine/api/messages/path.h"
#include "engine/api/signal.h"
#include "engine/math/deviation.h"

namespace vinerow {

class PlanStretch {
 public:
  /// Position of a point relative to the plan.
  struct Place {
    int segment = 0;
    double fraction = 0.0;    ///< 0..1 along the segment, in the plane
    double distance_m = 0.0;  ///< to the polyline: in the plane, for a flight in space
    double lateral_m = 0.0;   ///< to the segment in the plane, not negative
    double plan_z_m = 0.0;    ///< height of the plan there, in W
  };

  /// Subscribes to "plan", which is optional.
  void connect(Ports& ports);
  /// Takes over a plan that was written since the last call. Plans of fewer than two points are
  /// ignored.
  /// @returns whether the plan has changed
  bool take_over();
  /// Takes over a plan from another source, e.g. from a log. @returns as take_over()
  bool take_over(const PlannedPath& plan);

  bool has_plan() const { return !points_.empty(); }
  /// True if the plan has a stretch that is vertical or returns home: its heights are those of a
  /// flight.
  bool is_flight() const { return flight_.has_value(); }
  const std::vector<PathPoint>& points() const { return points_; }
  double length_m() const { return length_m_; }
  /// The points in the plane. @pre has_plan()
  const Polyline& line() const { return line_; }
  /// Nearest place; the search starts at the last result. No heap. @pre has_plan()
  Place find(const Eigen::Vector3d& p_W);
  bool is(PathKind kind, int segment) const { return points_[segment].kind == kind; }
  bool is_leg(int segment) const { return is(PathKind::kLeg, segment); }
  bool is_turn(int segment) const { return is(PathKind::kTurn, segment); }
  /// Lane that is flown or driven: the alley of the leg at the nearest place, 0 if the leg has no
  /// alley number. -1 off the legs, and if the motion deviates more than 60 degrees from the leg's
  /// direction (a return path across the lanes is on none of them). No heap.
  /// @param v_W  velocity over ground, m/s; below 0.1 m/s the direction is not checked
  int lane(const Eigen::Vector3d& p_W, const Eigen::Vector3d& v_W);
  /// True if the segment is steeper than 45 degrees, as at both ends of a return path.
  bool is_steep(int segment) const;

  /// Distance from the planned curve in the plane, m: from the arc through the segment's ends with
  /// the plan's curvature, because a chord of 0.25 m is 4.4 mm inside an arc of radius 1.77 m.
  /// Distance from the segment if it is straight, its curvature is impossible (chord longer than
  /// the diameter), or the nearest place is one of its ends.
  double curve_distance_m(const Place& at, const Eigen::Vector2d& p) const;

 private:
  SignalReader<PlannedPath> plan_;
  std::uint64_t plan_seen_ = 0;
  std::vector<PathPoint> points_;
  double length_m_ = 0.0;
  Polyline line_;
  std::optional<SpacePolyline> flight_;
  int segment_ = 0;  ///< last result
};

}  // namespace vinerow
