#pragma once
/// Exact distance between a triangle and a box, in double precision.
///
/// Derivation: f(x) = sum_i max(0, |x_i| - h_i)^2 is the squared distance of a point from the box.
/// It is convex, so its minimum over the triangle is (a) on an edge or (b) inside. On an edge x = a
/// + t d, f'(t) is piecewise linear and non-decreasing: its zero is found exactly between the at
/// most six breakpoints. Inside, the nearest feature of the box is a corner, the one farthest along
/// the triangle's normal towards it. (It may be an edge or face parallel to the triangle; then (a)
/// or the same corner gives the same distance.) Or the box passes through the triangle's interior
/// without touching its edges; then the box's diagonal along the normal meets the plane inside the
/// triangle.

#include <Eigen/Core>

namespace vinerow::physics {

/// Squared distance from segment a-b to the box |x_i| <= half_extents_i, m2.
double segment_box_distance2(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                             const Eigen::Vector3d& half_extents_m);

/// Squared distance from triangle a-b-c, in the box's frame, to the box; 0 if they overlap, m2.
/// Degenerate triangles (points, needles) count as segments.
double triangle_box_distance2(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                              const Eigen::Vector3d& c, const Eigen::Vector3d& half_extents_m);

/// Squared distance from the bounding box of a-b-c to the box: a cheap lower bound, m2.
double triangle_box_bound2(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                           const Eigen::Vector3d& c, const Eigen::Vector3d& half_extents_m);

}  // namespace vinerow::physics
