#pragma once
/// World with its prepared physics scene, which runs can share instead of building their own.

#include <cstdint>
#include <memory>

#include "engine/api/registry.h"
#include "engine/physics/static_scene.h"
#include "engine/scenario/scenario.h"

namespace vinerow {

struct BuiltWorld {
  std::shared_ptr<const WorldModel> model;
  std::shared_ptr<const physics::StaticScene> scene;  ///< of it, or of a twin with other wind
  std::uint64_t seed = 0;                             ///< of the run it was built for
};

/// Builds the world of a scenario. @param shelf  cache of files; may be null. @throws ConfigError
BuiltWorld build_static_world(const scenario::Scenario& scenario, const Registry& registry,
                              FileShelf* shelf = nullptr);

/// World of the same scenario with another seed. Rebuilds it only if it depends on the seed.
/// @throws ConfigError
BuiltWorld reseed_world(const BuiltWorld& world, const scenario::Scenario& scenario,
                        const Registry& registry, FileShelf* shelf = nullptr);

}  // namespace vinerow
