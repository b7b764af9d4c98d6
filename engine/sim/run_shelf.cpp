#include "engine/sim/run_shelf.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/scenario/scenario_seed.h"
#include "engine/sim/simulation.h"

namespace vinerow {

BuiltWorld RunShelf::world(const scenario::Scenario& scenario, const Registry& registry) {
  const std::string key =
      fmt::format("{} ns, {} m/s2\n{}", scenario.physics_step.ns, scenario.gravity_mps2,
                  scenario::resolved_block(scenario, "world"));
  // Held while a world is built, so that other runs wait for it instead of building it too.
  const std::lock_guard lock(mutex_);
  const auto found =
      std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) { return kept.key == key; });
  if (found != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, found);
    BuiltWorld& world = kept_.front().world;
    const WorldModel* model = world.model.get();
    world = reseed_world(world, scenario, registry, &files_);
    if (world.model.get() != model && world.model->depends_on_seed) ++built_;
    return world;
  }
  // Remove first: there may not be enough memory for two large worlds.
  while (kept_.size() >= max_worlds_) kept_.pop_back();
  kept_.push_front({key, build_static_world(scenario, registry, &files_)});
  ++built_;
  return kept_.front().world;
}

std::size_t RunShelf::built() const {
  const std::lock_guard lock(mutex_);
  return built_;
}

std::shared_ptr<const WorldModel> world_of(const scenario::Scenario& scenario,
                                           const Registry& registry, RunShelf* shelf) {
  if (shelf == nullptr) return build_world(scenario, registry);
  return shelf->world(scenario, registry).model;
}

}  // namespace vinerow
