#include "engine/sim/built_world.h"

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/profile.h"
#include "engine/sim/simulation.h"

namespace vinerow {
namespace {

/// True if the sentence starts with one of the parameters, "terrain_cell_m = 0.5 m gives ...", or
/// with a group of them.
bool begins_with_key(const std::string& text, const ParameterSet& parameters) {
  for (const ParameterSpec& spec : parameters.specs()) {
    if (text.starts_with(spec.name + " ") || text.starts_with(spec.name + ":")) return true;
  }
  return false;
}

}  // namespace

std::unique_ptr<WorldModel> build_world(const scenario::Scenario& scenario,
                                        const Registry& registry, FileShelf* shelf) {
  WorldContext context;
  context.part = "world";
  context.seed = scenario.seed;
  context.physics_step = scenario.physics_step;
  context.gravity_mps2 = scenario.gravity_mps2;
  context.shelf = shelf;
  const ParameterSet& parameters = scenario.world.parameters;
  try {
    return registry.make_world(scenario.world.type, parameters, context);
  } catch (const ConfigError& error) {
    // Prefix errors about a key with the place in the scenario file, as the loader does.
    const std::string text = error.what();
    if (!begins_with_key(text, parameters)) throw;
    throw ConfigError(fmt::format("{}: world.{}", scenario.world.place_of(text).text(), text));
  }
}

BuiltWorld build_static_world(const scenario::Scenario& scenario, const Registry& registry,
                              FileShelf* shelf) {
  BuiltWorld world;
  {
    const ProfileSpan span("world", "set-up");
    world.model = build_world(scenario, registry, shelf);
  }
  const ProfileSpan span("scene of the world", "set-up");
  world.scene = std::make_shared<const physics::StaticScene>(world.model);
  world.seed = scenario.seed;
  return world;
}

BuiltWorld reseed_world(const BuiltWorld& world, const scenario::Scenario& scenario,
                        const Registry& registry, FileShelf* shelf) {
  if (world.seed == scenario.seed) return world;
  if (world.model->depends_on_seed) return build_static_world(scenario, registry, shelf);
  BuiltWorld result = world;
  result.seed = scenario.seed;
  if (world.model->wind.random_gusts) {
    // Meshes are shared between both; terrain and rows are copied.
    auto model = std::make_shared<WorldModel>(*world.model);
    model->wind.random_gusts->seed = scenario.seed;
    result.model = std::move(model);
  }
  return result;
}

}  // namespace vinerow
