#pragma once
/// Triangle meshes and their placement: plain data, read from files and used by physics, rays and
/// pictures.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/surface.h"
#include "engine/math/pose.h"

namespace vinerow {

/// Indexed triangles, counter-clockwise seen from outside. Vertices in metres, z up.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Eigen::Vector3f> normals;  ///< per vertex, or empty
  std::vector<Eigen::Vector2f> uvs;      ///< per vertex, or empty
  std::vector<Eigen::Vector3f> colours;  ///< per vertex, linear RGB in [0, 1], or empty
  /// First triangle of each separate thing, as a leaf, a bunch or a post: ascending, from 0. Empty:
  /// the mesh is one thing.
  std::vector<std::uint32_t> things;

  Eigen::AlignedBox3d bounds() const {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3f& v : vertices) box.extend(v.cast<double>());
    return box;
  }
};

/// Whether cameras and 3D laser scanners see a mesh.
enum class Light : std::uint8_t {
  kAsDrawn,  ///< if it is visible
  kMeets,
  kPasses,  ///< as levels of detail do, and cards with the picture of a leaf
};

/// Leaves within the closed hull of a plant.
struct Foliage {
  double area_density_m2pm3 = 0.0;  ///< leaf area, one side, per volume of the hull; >= 0
  double leaf_width_m = 0.1;        ///< of a mean blade; > 0
};

struct MeshInstance {
  std::string name;
  std::shared_ptr<const TriangleMesh> mesh;
  Pose X_WM;
  SurfaceClass surface = SurfaceClass::kObstacle;
  Material material;
  bool collides = true;  ///< used by physics and rays
  bool visible = true;   ///< shown in pictures
  Light light = Light::kAsDrawn;
  std::optional<Label> label;      ///< absent: label_of(surface)
  std::optional<Foliage> foliage;  ///< of a canopy's hull; absent: not known
};

}  // namespace vinerow
