#pragma once
/// A vehicle's outline against a distance field: is a pose free, is a way free, how much room is
/// left.
///
/// The outline is sampled at the grid's cell size, its inside more coarsely; a cheap test with
/// circles that cover the outline answers most questions. No heap after construction.

#include <string>
#include <vector>

#include "controllers/parts/paths/distance_field.h"
#include "controllers/parts/paths/pose2.h"

namespace vinerow::controllers {

/// Polygon with every edge moved inwards. @param outline  convex, counter-clockwise
/// @returns empty if nothing is left
std::vector<Eigen::Vector2d> inset_polygon(const std::vector<Eigen::Vector2d>& outline,
                                           double inset_m);

class Footprint {
 public:
  /// @param field  must outlive this
  /// @param outline_B  convex, counter-clockwise (VehicleDescription::outline_B)
  /// @param margin_m  room that a free pose has all around, >= 0
  Footprint(const DistanceField& field, std::vector<Eigen::Vector2d> outline_B, double margin_m);

  /// Least distance of the outline to anything taken, m; 0 where they overlap. Accurate to a cell.
  double clearance_m(const Pose2& pose) const;
  /// clearance_m(pose) >= margin, without working it out where a cheap test suffices.
  bool is_free(const Pose2& pose) const;
  /// All poses along an arc at most `step_m` apart, ends included, and no touch between them: there
  /// the outline keeps what is left of the margin less 1 cm. @param length_m  negative: backwards
  bool is_free_along(const Pose2& start, double length_m, double curvature_per_m,
                     double step_m) const;
  /// Least clearance along an arc.
  double clearance_along_m(const Pose2& start, double length_m, double curvature_per_m,
                           double step_m) const;

  const DistanceField& field() const { return *field_; }
  double margin_m() const { return margin_m_; }
  const std::vector<Eigen::Vector2d>& outline_B() const { return outline_B_; }

 private:
  /// clearance_m(pose) >= room_m, likewise; the circles that hold the outline need far_room_m.
  bool is_clear(const Pose2& pose, double room_m, double far_room_m) const;
  /// Whether nothing comes nearer than `least_m` on an arc; by halves, down to 1 mm.
  bool is_swept_clear(const Pose2& start, double from_m, double to_m, double curvature_per_m,
                      double least_m) const;
  struct Circle {
    Eigen::Vector2d centre_B;
    double radius_m;
  };
  void add_ring(double depth_m);

  const DistanceField* field_;
  std::vector<Eigen::Vector2d> outline_B_;
  double margin_m_;
  std::vector<Circle> cover_;            // together they hold the outline
  std::vector<Eigen::Vector2d> edge_B_;  // samples of the outline
  double edge_reach_m_ = 0.0;            // half the distance between samples
  double farthest_m_ = 0.0;              // of the outline from B's origin
  std::vector<Circle> inside_B_;         // discs that touch the outline from inside
};

/// "(1.25, 3.00) heading 90.0 deg"
std::string to_string(const Pose2& pose);

/// Why a pose is not free, without its row: "at (1.25, 3.00) heading 90.0 deg the footprint has
/// 0.010 m of room, the margin is 0.050 m", or that it lies outside the map.
std::string describe_room(const Pose2& pose, const Footprint& footprint);

}  // namespace vinerow::controllers
