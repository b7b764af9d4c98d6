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
  return thing_of(mesh, number - first_[mesh]);
}

ThingNumbers::Thing ThingNumbers::thing_of(std::size_t mesh, std::size_t k) const {
  const std::vector<std::uint32_t>& things = meshes_[mesh].mesh->things;
  const auto all = static_cast<std::uint32_t>(meshes_[mesh].mesh->triangles.size());
  return {static_cast<int>(mesh), things.empty() ? 0 : things[k],
          k + 1 < things.size() ? things[k + 1] : all};
}

Label ThingNumbers::label(const RayHit& hit) const {
  if (hit.mesh < 0) return label_of(hit.surface);
  const MeshInstance& instance = meshes_[static_cast<std::size_t>(hit.mesh)];
  return instance.label.value_or(label_of(instance.surface));
}

std::uint32_t ThingNumbers::of(const RayHit& hit, Found& last) const {
  if (hit.mesh < 0) return kTerrain;
  const auto triangle = static_cast<std::uint32_t>(hit.triangle);
  if (hit.mesh == last.thing.mesh && triangle >= last.thing.first_triangle &&
      triangle < last.thing.end_triangle) {
    return last.number;
  }
  const auto mesh = static_cast<std::size_t>(hit.mesh);
  const std::vector<std::uint32_t>& things = meshes_[mesh].mesh->things;
  const auto after = std::upper_bound(things.begin(), things.end(), triangle);
  const auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - things.begin() - 1, 0));
  last = {thing_of(mesh, k), first_[mesh] + static_cast<std::uint32_t>(k)};
  return last.number;
}

}  // namespace vinerow::sensors
