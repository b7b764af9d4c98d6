#pragma once
/// Extension point Job: a mission phase that no vehicle does, such as building a cloud from
/// pictures or a map from a cloud. A job takes products of earlier phases and makes one product.

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
  std::map<std::string, double> numbers;  ///< written to summary.json; names carry units
  std::vector<std::string> notes;         ///< sentences for people
};

/// Context of a job. References live as long as the run.
struct JobContext : PartContext {
  const WorldModel* world = nullptr;  ///< the truth
  const SceneQuery* scene = nullptr;
  std::filesystem::path folder;  ///< the job's own output folder; exists before run()
  /// Plans a path for a vehicle of the run from its current position, with its own planner on a
  /// map.
  /// @param map  null: the map that the vehicle has without the job
  std::function<Result<PlannedPath>(const std::string& vehicle, std::shared_ptr<const RowMap> map)>
      plan;
};

/// Built while loading, so that its parameters are checked before the run starts.
class Job {
 public:
  virtual ~Job() = default;
  /// Runs once, between two physics steps. Limit iterations, never wall time: results must not
  /// depend on the machine.
  /// @param inputs  by ProductPort::key; required inputs are present, and each has its port's kind
  /// @returns the outcome, or the reason for the failure, which fails the phase
  virtual Result<JobOutcome> run(const std::map<std::string, Product>& inputs) = 0;
};

}  // namespace vinerow
