#pragma once
/// Instance of a generated mesh of plants or trellis.

#include <memory>
#include <string>
#include <utility>

#include "engine/api/mesh.h"

namespace vinerow::worlds {

/// Where the mesh's own frame is, with the colours of its vertices.
inline MeshInstance plant_instance(std::string name, std::shared_ptr<const TriangleMesh> mesh,
                                   SurfaceClass surface) {
  MeshInstance instance;
  instance.name = std::move(name);
  instance.mesh = std::move(mesh);
  instance.surface = surface;
  instance.material.name = to_string(surface);
  instance.material.colour = {1.0f, 1.0f, 1.0f};  // the vertices' colours count
  return instance;
}

}  // namespace vinerow::worlds
