#pragma once
/// Leaf area density of what a ray enters.

#include <cstddef>
#include <vector>

#include "engine/api/world_model.h"

namespace vinerow {

/// Of a vine row in full leaf, where the world does not know it: leaf area index 1.94 over rows
/// 2.5 m apart (docs/models/payloads.md).
constexpr double kUsualLeafAreaDensity_m2pm3 = 6.0;

/// Leaf area, one side, per volume of canopy, mesh by mesh.
class LeafAreaDensity {
 public:
  /// That of the hulls that state it, else the usual one.
  explicit LeafAreaDensity(const WorldModel& world) {
    for (const MeshInstance& instance : world.meshes) {
      m2pm3_.push_back(instance.foliage ? instance.foliage->area_density_m2pm3 : elsewhere_m2pm3_);
    }
  }
  /// The same in all canopy.
  explicit LeafAreaDensity(double everywhere_m2pm3) : elsewhere_m2pm3_(everywhere_m2pm3) {}

  /// @param mesh  as RayHit::mesh  @returns m2/m3
  double of(int mesh) const {
    const auto i = static_cast<std::size_t>(mesh);
    return mesh >= 0 && i < m2pm3_.size() ? m2pm3_[i] : elsewhere_m2pm3_;
  }

 private:
  std::vector<double> m2pm3_;
  double elsewhere_m2pm3_ = kUsualLeafAreaDensity_m2pm3;
};

}  // namespace vinerow
