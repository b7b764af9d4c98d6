#pragma once
/// Builder of display meshes from a few shapes: chamfered boxes, bevelled extrusions, lathes,
/// tubes. Every vertex has a normal and a colour, so that a link needs one mesh only.
///
/// Frames: shapes are given in a frame F, which `place` sets in the mesh's frame M.

#include <Eigen/Core>
#include <span>

#include "engine/api/mesh.h"
#include "engine/math/pose.h"

namespace vinerow::vehicles {

/// Linear RGB from an sRGB hex code such as 0x2f7d32.
Eigen::Vector3f colour_from_srgb(unsigned hex);

class MeshBuilder {
 public:
  /// Sets the frame of the shapes that follow. @param X_MF  pose of F in the mesh's frame
  MeshBuilder& place(const Pose& X_MF);
  MeshBuilder& place(double x_m, double y_m, double z_m);
  MeshBuilder& colour(const Eigen::Vector3f& rgb);

  /// Box around F's origin with all edges cut at 45 degrees. @param chamfer_m  0 for sharp edges
  MeshBuilder& box(const Eigen::Vector3d& half_extents_m, double chamfer_m);
  /// Convex outline in (x, z), counter-clockwise seen from -y, extruded over |y| <= half width,
  /// with both rims bevelled.
  MeshBuilder& extrude(std::span<const Eigen::Vector2d> outline, double half_width_m,
                       double bevel_m);
  /// Outline of (radius, y) turned about F's y axis. The outside is to the right of the outline's
  /// direction of +y. Smooth around the axis, and along it unless two points coincide.
  MeshBuilder& lathe(std::span<const Eigen::Vector2d> outline, int segments);
  /// Closed cylinder about F's y axis.
  MeshBuilder& cylinder(double radius_m, double half_width_m, int segments);
  /// Tube from a to b in F, closed at both ends.
  MeshBuilder& rod(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius_m,
                   int segments);
  /// Part of a ring about F's y axis (a mudguard), angles from x towards z.
  MeshBuilder& ring_sector(double inner_m, double outer_m, double half_width_m, double from_rad,
                           double to_rad, int segments);
  /// Flat face with four corners, counter-clockwise seen from outside.
  MeshBuilder& quad(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                    const Eigen::Vector3d& d);
  MeshBuilder& triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c);
  /// Another mesh, in its own colours if it has them, else in the current colour.
  MeshBuilder& append(const TriangleMesh& mesh);

  TriangleMesh take() { return std::move(mesh_); }

 private:
  std::uint32_t add_vertex(const Eigen::Vector3d& p_F, const Eigen::Vector3d& normal_F);
  TriangleMesh mesh_;
  Pose X_MF_;
  Eigen::Vector3f colour_ = {0.7f, 0.7f, 0.7f};
};

}  // namespace vinerow::vehicles
