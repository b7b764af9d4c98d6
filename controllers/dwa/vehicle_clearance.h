#pragma once
/// Clearance of a vehicle at a pose, to obstacles of the map and to obstacles detected since.
///
/// The outline is a set of discs: three along the vehicle, a single one around it (paper A's
/// "circular safe zone"), or the polygon itself as many points on its edge. All results are
/// distances from the outline, negative where a disc overlaps.

#include <vector>

#include "controllers/dwa/point_field.h"
#include "controllers/parts/paths/distance_field.h"
#include "controllers/parts/paths/pose2.h"

namespace vinerow::controllers {

/// A vehicle's outline as discs in B.
class DiscOutline {
 public:
  struct Disc {
    Eigen::Vector2d centre_B;
    double radius_m;
    bool only_overlap = false;  ///< inside the outline: counts only if something is within it
  };

  /// Discs of one radius at x = -spacing, 0, +spacing. Reference values for the 1.5 x 1.0 m hull:
  /// 0.56 m, 0.5 m.
  static DiscOutline three_circles(double radius_m, double spacing_m);
  /// The smallest disc about B's origin that contains the outline (paper A, section 3.2).
  static DiscOutline circumscribed(const std::vector<Eigen::Vector2d>& outline_B);
  /// The outline itself, sampled every `spacing_m`. @param outline_B convex, counter-clockwise
  static DiscOutline polygon(const std::vector<Eigen::Vector2d>& outline_B,
                             double spacing_m = 0.05);

  const std::vector<Disc>& discs() const { return discs_; }
  /// A few discs that contain all others; empty if that saves nothing.
  const std::vector<Disc>& cover() const { return cover_; }
  /// Largest distance of the outline outside the discs, m; 0 if they cover it.
  double uncovered_m(const std::vector<Eigen::Vector2d>& outline_B) const;

 private:
  std::vector<Disc> discs_;
  std::vector<Disc> cover_;
};

/// Distances from the outline, m.
struct FreeSpace {
  double known_m = 0.0;    ///< to obstacles of the map
  double unknown_m = 0.0;  ///< to detected obstacles that the map lacks
  double min_m() const { return std::min(known_m, unknown_m); }
  bool meets(const FreeSpace& need) const {
    return known_m >= need.known_m && unknown_m >= need.unknown_m;
  }
};

/// Clearance queries for poses. Both fields must outlive it.
class FreeSpaceFinder {
 public:
  FreeSpaceFinder(const DistanceField& known, const PointField& unknown)
      : known_(&known), unknown_(&unknown) {}

  /// @param ahead  unit vector of the heading
  FreeSpace measure(const DiscOutline& outline, const Eigen::Vector2d& p_W,
                    const Eigen::Vector2d& ahead) const;
  FreeSpace measure(const DiscOutline& outline, const Pose2& pose) const {
    return measure(outline, pose.p, direction(pose.yaw_rad));
  }
  /// measure(...).meets(need), by the cover if that suffices.
  bool meets(const DiscOutline& outline, const Eigen::Vector2d& p_W, const Eigen::Vector2d& ahead,
             const FreeSpace& need) const;
  /// Clearance of the cover: never more than that of the outline, and cheap.
  FreeSpace measure_cover(const DiscOutline& outline, const Eigen::Vector2d& p_W,
                          const Eigen::Vector2d& ahead) const {
    return measure_discs(outline.cover().empty() ? outline.discs() : outline.cover(), p_W, ahead);
  }

 private:
  FreeSpace measure_discs(const std::vector<DiscOutline::Disc>& discs, const Eigen::Vector2d& p_W,
                          const Eigen::Vector2d& ahead) const;
  const DistanceField* known_;
  const PointField* unknown_;
};

}  // namespace vinerow::controllers
