#pragma once
/// Rays against the triangle surface of a HeightField, in double precision and without a copy of
/// it.
///
/// Along a ray the height above the surface, D(t) = z(t) - h(x(t), y(t)), is continuous and, in
/// each cell, linear on either side of the diagonal. The ray visits the cells that it crosses and
/// stops where D changes sign. It skips what lies above or below all samples under it, of a long
/// section first and then block by block. A ray that starts above the surface and rises more
/// steeply than the surface anywhere visits no cell: D only grows. Heights are compared above a
/// plane through the whole surface, z(t) - e(x(t), y(t)) with h - e: on a slope they differ less
/// than heights. Both sides of the surface are hit; the surface ends at the grid's edge.

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "engine/api/forward.h"
#include "engine/physics/height_ranges.h"

namespace vinerow {
struct SceneRay;
}

namespace vinerow::physics {

class HeightFieldRay {
 public:
  /// @param field  valid, outlives this object
  explicit HeightFieldRay(const HeightField& field);

  struct Hit {
    double distance_m = 0.0;
    Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  ///< unit, towards the ray's origin
  };
  /// First crossing within max_distance_m. @param dir_W unit. No heap, thread safe.
  std::optional<Hit> cast(const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W,
                          double max_distance_m) const;
  /// Where a ray starts. Rays of a fan that follow each other share it.
  struct Origin {
    Eigen::Vector3d p_W = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    double gap_m = -1.0;  ///< to the surface under it; negative: below it, or none
  };
  /// Quick proof, by the steepest slope alone, that cast() finds no hit.
  /// @param origin  of the ray before, then of this one
  bool stays_above(const SceneRay& ray, Origin& origin) const;

  const HeightField& field() const { return field_; }

 private:
  struct Walk;
  class GridWalk;
  struct Span {
    int i0, j0, i1, j1;  ///< cells of both ends
    bool is_one_cell() const { return i0 == i1 && j0 == j1; }
  };
  static Eigen::Vector2d calc_tilt_m(const HeightField& field);
  /// Rise above the tilted plane per metre of ray.
  double climb_of(const Eigen::Vector3d& dir_W) const {
    return dir_W.z() - (tilt_m_.x() * (dir_W.x() * inverse_cell_per_m_) +
                        tilt_m_.y() * (dir_W.y() * inverse_cell_per_m_));
  }
  bool outclimbs(const Eigen::Vector3d& dir_W) const;
  double gap_m(const Eigen::Vector3d& p_W) const;
  static bool clip(Walk& walk, double low_m, double high_m, double& t0, double& t1);
  bool clip_dive(Walk& walk, const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W, double& t0,
                 double& t1) const;
  bool clip_to_ground(Walk& walk, double& t0, double& t1) const;
  std::optional<Span> span_of(const Walk& walk, double max_distance_m) const;
  bool is_above(const Walk& walk, const Span& span, double max_distance_m) const;
  Hit hit_of(const Walk& walk, const Eigen::Vector3d& dir_W) const;
  bool cross_cell(Walk& walk, int i, int j, double t0, double t1) const;
  template <class Cross>
  static bool cross_squares(const Walk& walk, int cells, const int corner[2], const int end[2],
                            double t0, double t1, const Cross& cross);
  bool is_clear(Walk& walk, int level, int i, int j, double t0, double t1) const;
  bool cross_square(Walk& walk, int level, int i, int j, double t0, double t1) const;

  const HeightField& field_;
  double inverse_cell_per_m_;
  Eigen::Vector2d tilt_m_;  ///< rise of a plane per cell, along x and y
  HeightRanges ranges_;     ///< above that plane
  double steepest_ = 0.0;   ///< largest rise per horizontal metre of all triangles, above the plane
};

}  // namespace vinerow::physics
