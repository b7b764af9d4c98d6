#include "engine/sensors/camera/thing_numbers.h"

#include <algorithm>

namespace vinerow::sensors {

ThingNumbers::ThingNumbers(std::span<const MeshInstance> meshes) : meshes_(meshes) {
  for (const MeshInstance& instance : meshes) {
    first_.push_back(end_);
    if (!instance.mesh) continue;
    // Farther levels of detail, which no ray meets, have no things and take one number each.
    end_ += static_cast<std::uint32_t>(std::max<std::size_t>(instance.mesh->things.size(), 1));
  }
}

ThingNumbers::Thing ThingNumbers::thing(std::uint32_t number) const {
  if (number <= kTerrain || number >= end_) return {};
  const auto after = std::upper_bound(first_.begin(), first_.end(), number);
  const auto mesh = static_cast<std::size_t>(after - first_.begin() - 1);
  if (!meshes_[mesh].mesh) return {};
  const std::vector<std::uint32_t>& things = meshes_[mesh].mesh->things;
  const auto all = static_cast<std::uint32_t>(meshes_[mesh].mesh->triangles.size());
  const std::size_t k = number - first_[mesh];
  return {static_cast<int>(mesh), things.empty() ? 0 : things[k],
          k + 1 < things.size() ? things[k + 1] : all};
}

std::uint32_t ThingNumbers::of(const RayHit& hit) const {
  if (hit.mesh < 0) return kTerrain;
  const auto mesh = static_cast<std::size_t>(hit.mesh);
  const std::vector<std::uint32_t>& things = meshes_[mesh].mesh->things;
  const auto after =
      std::upper_bound(things.begin(), things.end(), static_cast<std::uint32_t>(hit.triangle));
  const auto thing = std::max<std::ptrdiff_t>(after - things.begin() - 1, 0);
  return first_[mesh] + static_cast<std::uint32_t>(thing);
}

}  // namespace vinerow::sensors
