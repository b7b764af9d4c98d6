#pragma once
/// Cache of file contents and built worlds, shared by the runs of one process.

#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "engine/api/file_shelf.h"
#include "engine/sim/built_world.h"

namespace vinerow {

/// Safe to call from several threads.
class RunShelf {
 public:
  /// @param max_worlds  number of worlds to keep, the most recently requested ones; >= 1
  explicit RunShelf(std::size_t max_worlds = 1) : max_worlds_(max_worlds) {}

  FileShelf& files() { return files_; }
  /// World of a scenario; built unless the shelf has one with the same parameters. A world that
  /// depends on the seed is rebuilt for another seed. Files are assumed to be unchanged.
  /// @throws ConfigError
  BuiltWorld world(const scenario::Scenario& scenario, const Registry& registry);
  /// Number of worlds built so far.
  std::size_t built() const;

 private:
  struct Kept {
    std::string key;  ///< everything that a world depends on, except the seed
    BuiltWorld world;
  };
  std::size_t max_worlds_;
  FileShelf files_;
  mutable std::mutex mutex_;
  std::list<Kept> kept_;  ///< most recently requested first
  std::size_t built_ = 0;
};

/// World of a scenario: the shelf's, or a new one without a shelf. @param shelf  may be null
/// @throws ConfigError
std::shared_ptr<const WorldModel> world_of(const scenario::Scenario& scenario,
                                           const Registry& registry, RunShelf* shelf);

}  // namespace vinerow
