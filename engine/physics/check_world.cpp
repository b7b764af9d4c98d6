#include "engine/physics/check_world.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "engine/api/height_field.h"
#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"

namespace vinerow::physics {
namespace {

void check_mesh(const std::string& name, const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) {
    throw ConfigError(fmt::format("mesh '{}' has no triangles", name));
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!mesh.vertices[v].allFinite()) {
      throw ConfigError(fmt::format("mesh '{}': vertex {} is not finite", name, v));
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (v >= mesh.vertices.size()) {
        throw ConfigError(
            fmt::format("mesh '{}': triangle {} refers to vertex {}, but there are {} vertices",
                        name, t, v, mesh.vertices.size()));
      }
    }
  }
}

void check_terrain(const HeightField& field) {
  if (field.columns < 2 || field.rows < 2) {
    throw ConfigError(fmt::format("terrain has {} x {} samples, must be 2 x 2 or more",
                                  field.columns, field.rows));
  }
  if (!(field.cell_m > 0.0) || !std::isfinite(field.cell_m)) {
    throw ConfigError(fmt::format("terrain: cell_m = {}, must be > 0", field.cell_m));
  }
  if (!field.corner_W.allFinite()) throw ConfigError("terrain: corner_W is not finite");
  const std::size_t wanted = static_cast<std::size_t>(field.columns) * field.rows;
  if (field.heights_m.size() != wanted) {
    throw ConfigError(fmt::format("terrain has {} heights, must be {} x {} = {}",
                                  field.heights_m.size(), field.columns, field.rows, wanted));
  }
  for (std::size_t k = 0; k < wanted; ++k) {
    if (!std::isfinite(field.heights_m[k])) {
      throw ConfigError(fmt::format("terrain: height of sample ({}, {}) is not finite",
                                    k % field.columns, k / field.columns));
    }
  }
}

}  // namespace

void check_world(const WorldModel& world) {
  if (world.terrain) check_terrain(*world.terrain);
  std::set<const TriangleMesh*> checked;
  for (const MeshInstance& instance : world.meshes) {
    if (!instance.mesh) throw ConfigError(fmt::format("mesh '{}' is missing", instance.name));
    if (!instance.X_WM.p.allFinite() || std::abs(instance.X_WM.q.norm() - 1.0) > 1e-6) {
      throw ConfigError(
          fmt::format("mesh '{}': pose must be finite with a unit quaternion", instance.name));
    }
    if (checked.insert(instance.mesh.get()).second) check_mesh(instance.name, *instance.mesh);
  }
}

}  // namespace vinerow::physics
