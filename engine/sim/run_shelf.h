#pragma once
/// What runs of one process share although their scenarios differ: contents of files, built worlds.

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
  /// @param most_worlds  kept, those that were asked for last; >= 1
  explicit RunShelf(std::size_t most_worlds = 1) : most_worlds_(most_worlds) {}

  FileShelf& files() { return files_; }
  /// The world of a scenario, built unless it was asked for before with the same parameters. A
  /// world that depends on the seed is built anew for another one. Files are taken to be unchanged.
  /// @throws ConfigError
  BuiltWorld world(const scenario::Scenario& scenario, const Registry& registry);
  /// How many worlds were built so far.
  std::size_t built() const;

 private:
  struct Kept {
    std::string key;  ///< all that a world depends on but the seed
    BuiltWorld world;
  };
  std::size_t most_worlds_;
  FileShelf files_;
  mutable std::mutex mutex_;
  std::list<Kept> kept_;  ///< the last one that was asked for stands first
  std::size_t built_ = 0;
};

}  // namespace vinerow
