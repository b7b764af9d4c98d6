#include "engine/physics/terrain_gate.h"

#include <algorithm>
#include <cmath>

#include "engine/api/height_field.h"

namespace vinerow::physics {
namespace {

/// Chosen: with more samples the narrow phase itself is hardly more expensive.
constexpr int kMaxSamples = 4096;

}  // namespace

bool is_clear_of_terrain(const HeightField& terrain, const btCollisionObject& body,
                         double margin_m) {
  const btTransform& X_WB = body.getWorldTransform();
  const btVector3 up_W = X_WB.getBasis().getColumn(2);
  btVector3 low_B, high_B, low_W, high_W;
  body.getCollisionShape()->getAabb(btTransform::getIdentity(), low_B, high_B);
  body.getCollisionShape()->getAabb(X_WB, low_W, high_W);

  const auto index = [&](double at, double corner) { return (at - corner) / terrain.cell_m; };
  const double i0 = std::floor(index(low_W.x(), terrain.corner_W.x()));
  const double j0 = std::floor(index(low_W.y(), terrain.corner_W.y()));
  const double i1 = std::ceil(index(high_W.x(), terrain.corner_W.x()));
  const double j1 = std::ceil(index(high_W.y(), terrain.corner_W.y()));
  const bool is_on_grid = i0 >= 0 && j0 >= 0 && i1 < terrain.columns && j1 < terrain.rows;
  if (!is_on_grid || (i1 - i0 + 1) * (j1 - j0 + 1) > kMaxSamples) return false;

  const double plane = up_W.dot(X_WB.getOrigin()) + low_B.z() - margin_m;
  double highest = -INFINITY;
  for (int j = static_cast<int>(j0); j <= static_cast<int>(j1); ++j) {
    const double y = terrain.corner_W.y() + j * terrain.cell_m;
    const float* heights = &terrain.heights_m[static_cast<std::size_t>(j) * terrain.columns];
    for (int i = static_cast<int>(i0); i <= static_cast<int>(i1); ++i) {
      const double x = terrain.corner_W.x() + i * terrain.cell_m;
      highest = std::max(highest, up_W.x() * x + up_W.y() * y + up_W.z() * heights[i]);
    }
  }
  return highest < plane;
}

}  // namespace vinerow::physics
