#pragma once
/// Collision test and clearance of a vehicle's outline on a distance field, for poses and arcs.
///
/// The outline is sampled at the grid's cell size, its inside more coarsely. A cheap test with
/// circles that cover the outline decides most queries. No heap after construction.

#include <string>
#include <vector>

#include "controllers/parts/paths/distance_field.h"
#include "controllers/parts/paths/pose2.h"
#include "engine/math/polygon.h"

namespace vinerow::controllers {

class Footprint {
 public:
  /// @param field  must outlive this
  /// @param outline_B  convex, counter-clockwise (VehicleDescription::outline_B)
  /// @param margin_m  clearance that a free pose has all around, >= 0
  Footprint(const DistanceField& field, std::vector<Eigen::Vector2d> outline_B, double margin_m);

  /// Smallest distance from the outline to an occupied cell, m; 0 if they overlap. Accurate to a
  /// cell.
  double clearance_m(const Pose2& pose) const;
  /// clearance_m(pose) >= margin; skips the computation if a cheap test suffices.
  bool is_free(const Pose2& pose) const;
  /// All poses along an arc at most `step_m` apart, ends included, are free, and there is no
  /// contact between them: there the outline keeps what remains of the margin, minus 1 cm.
  /// @param length_m  negative: backwards
  bool is_free_along(const Pose2& start, double length_m, double curvature_per_m,
                     double step_m) const;
  /// Smallest clearance along an arc.
  double clearance_along_m(const Pose2& start, double length_m, double curvature_per_m,
                           double step_m) const;

  const DistanceField& field() const { return *field_; }
  double margin_m() const { return margin_m_; }
  const std::vector<Eigen::Vector2d>& outline_B() const { return outline_B_; }

 private:
  /// clearance_m(pose) >= min_clearance_m, likewise; the covering circles need far_clearance_m.
  bool is_clear(const Pose2& pose, double min_clearance_m, double far_clearance_m) const;
  /// Whether nothing comes nearer than `min_m` on an arc; by bisection, down to 1 mm.
  bool is_swept_clear(const Pose2& start, double from_m, double to_m, double curvature_per_m,
                      double min_m) const;
  struct Circle {
    Eigen::Vector2d centre_B;
    double radius_m;
  };
  void add_ring(double depth_m);

  const DistanceField* field_;
  std::vector<Eigen::Vector2d> outline_B_;
  double margin_m_;
  std::vector<Circle> cover_;            // together they contain the outline
  std::vector<Eigen::Vector2d> edge_B_;  // samples of the outline
  double edge_reach_m_ = 0.0;            // half the distance between samples
  double farthest_m_ = 0.0;              // of the outline from B's origin
  std::vector<Circle> inside_B_;         // discs that touch the outline from inside
};

/// "(1.25, 3.00) heading 90.0 deg"
std::string to_string(const Pose2& pose);

/// Why a pose is not free, without its row: "at (1.25, 3.00) heading 90.0 deg the footprint has
/// 0.010 m of clearance, the margin is 0.050 m", or that it is outside the map.
std::string describe_clearance(const Pose2& pose, const Footprint& footprint);

}  // namespace vinerow::controllers
