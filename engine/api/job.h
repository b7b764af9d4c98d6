#pragma once
/// Extension point Job: work of a mission that no vehicle does, as turning pictures into a cloud
/// and a cloud into a map. A job is a phase of its own; it takes products of earlier phases and
/// gives one.

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/messages/path.h"
#include "engine/api/part.h"
#include "engine/api/product.h"
#include "engine/api/scene_query.h"
#include "engine/core/result.h"

namespace vinerow {

struct JobOutcome {
  Product product;
  std::map<std::string, double> numbers;  ///< with units in their names; into summary.json
  std::vector<std::string> notes;         ///< sentences for people
};

/// What a job needs beside PartContext. References live as long as the run.
struct JobContext : PartContext {
  const WorldModel* world = nullptr;  ///< the truth
  const SceneQuery* scene = nullptr;
  std::filesystem::path folder;  ///< its own, for files; made before run()
  /// Plans for a vehicle of the run from where it stands, with its own planner on a map.
  /// @param map  null: the map that the vehicle has without the job
  std::function<Result<PlannedPath>(const std::string& vehicle, std::shared_ptr<const RowMap> map)>
      plan;
};

/// Built while loading, so that its parameters are checked before anything runs.
class Job {
 public:
  virtual ~Job() = default;
  /// Runs once, between two physics steps. Stops on iterations, never on seconds.
  /// @param inputs  by ProductPort::key; required ones are there, and each is of its kind
  /// @returns the outcome, or the reason why there is none, which fails the phase
  virtual Result<JobOutcome> run(const std::map<std::string, Product>& inputs) = 0;
};

}  // namespace vinerow
