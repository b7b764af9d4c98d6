#pragma once
/// Triangle meshes and where they stand: plain data that files are read into, and physics, rays and
/// pictures use.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/math/pose.h"

namespace vinerow {

/// Indexed triangles, counter-clockwise seen from outside. Vertices in metres, z up.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Eigen::Vector3f> normals;  ///< per vertex, or empty
  std::vector<Eigen::Vector2f> uvs;      ///< per vertex, or empty
  std::vector<Eigen::Vector3f> colours;  ///< per vertex, linear RGB in [0, 1], or empty

  Eigen::AlignedBox3d bounds() const {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3f& v : vertices) box.extend(v.cast<double>());
    return box;
  }
};

/// What a surface is; decides how it looks, whether a sensor sees it, and what a contact with it
/// means.
enum class SurfaceClass : std::uint8_t {
  kTerrain,   ///< ground: wheels roll on it
  kCanopy,    ///< leaves and shoots: counted as contact, does not push (foliage gives way)
  kPost,      ///< posts and end assemblies: rigid
  kTrunk,     ///< vine or tree stems: rigid
  kWire,      ///< trellis wires: drawn only
  kObstacle,  ///< anything else that is rigid
  kVehicle,
};

/// "post": for events and errors.
const char* to_string(SurfaceClass surface);

/// How to draw a surface.
struct Material {
  std::string name;
  Eigen::Vector3f colour = {0.7f, 0.7f, 0.7f};  ///< linear RGB
  float roughness = 0.9f;
  std::string
      texture;  ///< absolute path of an image, or "" for none, or "builtin:<name>" (see render/)
  bool leaf_cards = false;  ///< alpha-tested, two-sided, lit as foliage
};

struct MeshInstance {
  std::string name;
  std::shared_ptr<const TriangleMesh> mesh;
  Pose X_WM;
  SurfaceClass surface = SurfaceClass::kObstacle;
  Material material;
  bool collides = true;  ///< physics and rays know it
  bool visible = true;   ///< pictures show it
};

}  // namespace vinerow
