#pragma once
/// Numbers of the things in a world, for instance pictures: each leaf, bunch, trunk and post has
/// its own, the same in every picture of a run and of every run in the same world.
///
/// 0: sky and what is beyond the world; 1: the terrain; then the things of the meshes in their
/// order, then the vehicles in the order of the scenario file.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/api/mesh.h"
#include "engine/api/scene_query.h"

namespace vinerow::sensors {

class ThingNumbers {
 public:
  static constexpr std::uint32_t kNothing = 0, kTerrain = 1;

  /// @param meshes  of the world; outlive this object
  explicit ThingNumbers(std::span<const MeshInstance> meshes);

  /// A thing of the world: triangles of one of its meshes.
  struct Thing {
    int mesh = -1;  ///< index; -1: nothing, the terrain, or a vehicle
    std::uint32_t first_triangle = 0, end_triangle = 0;
  };
  Thing thing(std::uint32_t number) const;

  /// A thing and its number.
  struct Found {
    Thing thing;
    std::uint32_t number = kNothing;
  };
  /// Number of what a ray met in the world. @param last  what the ray before met, often the same
  /// thing; then what this one met
  std::uint32_t of(const RayHit& hit, Found& last) const;
  /// Class of what a ray met in the world.
  Label label(const RayHit& hit) const;
  std::uint32_t of_vehicle(int vehicle) const { return end_ + static_cast<std::uint32_t>(vehicle); }
  /// First number that no thing of the world has.
  std::uint32_t end() const { return end_; }

 private:
  /// @param k  which of the mesh's things
  Thing thing_of(std::size_t mesh, std::size_t k) const;

  std::span<const MeshInstance> meshes_;
  std::vector<std::uint32_t> first_;  ///< of each mesh
  std::uint32_t end_ = kTerrain + 1;
};

}  // namespace vinerow::sensors
