#pragma once
/// Primitives of plant and trellis meshes: tubes and leaf cards, appended to a mesh.
///
/// Vertices are in the frame of the points given. Cost: heap for the mesh only.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "engine/api/forward.h"
#include "engine/math/pose.h"

namespace vinerow::worlds {

/// 137.5 degrees: leaves, berries and tufts that follow each other by it spread evenly around.
constexpr double kGoldenAngle_rad = 2.399963229728653;

/// Ring of a tube.
struct TubePoint {
  Eigen::Vector3d p;
  double radius_m;
};

/// Appends a closed tube of round cross-section through the points, with end caps, normals and
/// colours.
/// @param points  >= 2, neighbours distinct
/// @param sides   >= 3
void append_tube(TriangleMesh& mesh, std::span<const TubePoint> points, int sides,
                 const Eigen::Vector3f& colour);

/// Appends a sphere of 20 faces with normals and colours.
void append_sphere(TriangleMesh& mesh, const Eigen::Vector3d& centre, double radius_m,
                   const Eigen::Vector3f& colour);

/// Flat quad of two triangles with a leaf texture.
struct LeafCard {
  Eigen::Vector3d stem;    ///< middle of the lower edge (uv 0.5, 0)
  Eigen::Vector3d tip;     ///< middle of the upper edge (uv 0.5, 1)
  Eigen::Vector3d side;    ///< from the middle line to the right edge, m
  Eigen::Vector3d normal;  ///< for shading, unit; blended outward by the caller
  Eigen::Vector3f colour;
};

/// Appends uv in [0, 1]^2, v from stem to tip.
void append_card(TriangleMesh& mesh, const LeafCard& card);

/// Unit vector, any direction alike.
Eigen::Vector3d random_direction(RandomStream& random);

/// Unit vector perpendicular to a unit vector.
Eigen::Vector3d any_orthogonal(const Eigen::Vector3d& unit);

/// Area-weighted vertex normals; replaces `normals`. Vertices without triangles get +z.
void calc_vertex_normals(TriangleMesh& mesh);

}  // namespace vinerow::worlds
