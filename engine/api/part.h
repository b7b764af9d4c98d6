#pragma once
/// Common base of exchangeable parts: spec, context and stepping.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/parameters.h"
#include "engine/api/product_port.h"
#include "engine/api/result_spec.h"
#include "engine/api/signal.h"
#include "engine/core/time.h"

namespace vinerow {

/// Declaration of a part for `vinerow list`, the JSON Schema and the loader.
struct PartSpec {
  std::string name;         ///< the `type` in scenario files, snake_case
  std::string description;  ///< one sentence, with the paper and equations it implements
  std::vector<ParameterSpec> parameters;
  /// Rules across parameters, from their tables. Each throws the ConfigError of
  /// ParameterTable::validate.
  std::vector<std::function<void(const ParameterSet& parameters, const std::string& who)>> checks;
  double default_rate_Hz = 0.0;    ///< of stepped parts; 0 = every physics step or not stepped
  std::vector<std::string> reads;  ///< local signal names, for documentation
  std::vector<std::string> writes;
  std::vector<ResultSpec> results;  ///< of metrics, payloads and jobs
  std::string version = "1";
  std::vector<ProductPort> takes;    ///< of jobs
  std::optional<ProductKind> gives;  ///< of jobs; kPictures for cameras that survey
};

/// Context in which a part is built. References live as long as the run.
struct PartContext {
  std::string vehicle;     ///< name of its vehicle, "" for worlds and run-wide metrics
  std::string part;        ///< full name, e.g. "rover.controller", for errors
  std::uint64_t seed = 0;  ///< of the run
  Duration period;         ///< of the part; 0 if it is not stepped
  Duration physics_step;
  double gravity_mps2 = 9.80665;
  /// Cache for file contents (file_shelf.h); null: nothing is cached.
  FileShelf* shelf = nullptr;
  /// A new random stream of this part; `component` distinguishes several streams of one part.
  RandomStream random(const std::string& component = "") const;
};

/// A part that runs at its own rate between physics steps: estimator, guidance, controller, sensor,
/// payload, metric.
class SteppedPart {
 public:
  virtual ~SteppedPart() = default;
  /// Declares the signals it reads and writes. Called once, before the first step.
  virtual void connect(Ports& ports) = 0;
  /// One tick. Does not throw, allocate or log in a normal step.
  /// @param now  simulated time of the tick
  virtual void step(Time now) = 0;
};

}  // namespace vinerow
