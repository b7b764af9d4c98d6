#pragma once
/// A world with all that physics has prepared of it: what a run can be given instead of building
/// it, and what runs can share.

#include <cstdint>
#include <memory>

#include "engine/api/registry.h"
#include "engine/physics/static_scene.h"
#include "engine/scenario/scenario.h"

namespace vinerow {

struct BuiltWorld {
  std::shared_ptr<const WorldModel> model;
  std::shared_ptr<const physics::StaticScene> scene;  ///< of it, or of one with another wind
  std::uint64_t seed = 0;                             ///< of the run it is for
};

/// The world of a scenario. @param shelf  of files; null: none. @throws ConfigError
BuiltWorld build_static_world(const scenario::Scenario& scenario, const Registry& registry,
                              FileShelf* shelf = nullptr);

/// The same for the same scenario with another seed. Only a world that depends on the seed is built
/// anew. @throws ConfigError
BuiltWorld reseed_world(const BuiltWorld& world, const scenario::Scenario& scenario,
                        const Registry& registry, FileShelf* shelf = nullptr);

}  // namespace vinerow
