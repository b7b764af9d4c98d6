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
#include <optional>

#include "engine/api/forward.h"
#include "engine/physics/height_ranges.h"

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

  const HeightField& field() const { return field_; }

 private:
  struct Walk;
  class GridWalk;
  struct Span {
    int i0, j0, i1, j1;  ///< cells of both ends
    bool is_one_cell() const { return i0 == i1 && j0 == j1; }
  };
  static Eigen::Vector2d calc_tilt_m(const HeightField& field);
  bool rises_above(const Walk& walk, const Eigen::Vector3d& p_W,
                   const Eigen::Vector3d& dir_W) const;
  static bool clip(Walk& walk, double low_m, double high_m, double& t0, double& t1);
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
