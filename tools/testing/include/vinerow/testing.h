#pragma once
/// Test of a custom part against physics: build a tiny world, put a vehicle and the part in it,
/// step, assert.
///
///   TEST(MyController, FollowsARow) {
///     vinerow::testing::TestRun run = vinerow::testing::SmallWorld()
///                                         .vehicle("rover", "diff_drive_rover")
///                                         .planner("rover", "coverage")
///                                         .controller("rover", my_spec(), make_my_controller)
///                                         .build();
///     run.run_for_s(20.0);
///     EXPECT_LT(run.metric("rover", "cross_track_max_m"), 0.2);
///   }
///
/// Part parameters are the content of a YAML mapping, with the keys of scenario files:
/// "lookahead_m: 0.5, rate_Hz: 20". Everything is checked as in a file; a ConfigError explains the
/// fault. No files are written. Needs no GoogleTest.

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/messages.h"
#include "engine/api/registry.h"
#include "vinerow/session.h"

namespace vinerow {
class Simulation;
}

namespace vinerow::testing {

/// Run in memory, stepped and queried by a test.
class TestRun {
 public:
  /// Loads a scenario file. @param sets  overrides as on the command line,
  /// "rover.controller.lookahead_m=0.5"
  static TestRun from_file(const std::filesystem::path& file,
                           const std::vector<std::string>& sets = {});
  /// Loads a scenario text. @param folder  base of its relative paths
  static TestRun from_yaml(const std::string& yaml, const std::filesystem::path& folder = ".");

  /// Advances by this simulated time, or to the end of the mission. @throws SimulationError
  TestRun& run_for_s(double duration_s);
  TestRun& run_to_end();

  double time_s() const;
  /// True if every controller has finished.
  bool finished() const;
  /// Metric so far. @throws ConfigError with the nearest name for an unknown vehicle or metric
  double metric(const std::string& vehicle, const std::string& name) const;
  std::map<std::string, double> metrics(const std::string& vehicle) const;
  /// True pose and twist at the last instant.
  const Odometry& truth(const std::string& vehicle) const;
  /// Last value of any signal, e.g. signal<FollowerState>("rover/follower").
  /// @throws ConfigError if the signal does not exist, has another type, or was never written
  template <class T>
  const T& signal(const std::string& name) const {
    return static_cast<const Signal<T>&>(written_signal(name, message_type<T>())).value();
  }
  std::string digest() const;
  /// Full interface of the run.
  Session& session() { return session_; }
  Simulation& simulation() { return session_.simulation(); }

 private:
  friend class SmallWorld;
  explicit TestRun(Session session) : session_(std::move(session)) {}
  /// @throws ConfigError unless the signal has this message type and has been written
  const SignalBase& written_signal(const std::string& name, const MessageType& type) const;

  Session session_;
};

/// Builds a TestRun: by default a flat block of two 20 m rows, 2.5 m apart, with one alley between
/// them, and a physics step of 1 ms. Every call returns the builder.
///
/// A part is given by its type, as in a scenario file, or, for a custom part without a plug-in, by
/// its spec and factory. The first call with a spec makes the type known in the whole world; other
/// calls name it. `parameters` is always the content of a YAML mapping.
class SmallWorld {
 public:
  SmallWorld();
  ~SmallWorld();
  SmallWorld(SmallWorld&&) noexcept;
  SmallWorld& operator=(SmallWorld&&) noexcept;

  /// Replaces the default world.
  SmallWorld& world(const std::string& type, const std::string& parameters = "");
  SmallWorld& world(PartSpec spec, PartFactory<WorldModel, WorldContext> make,
                    const std::string& parameters = "");

  /// @param parameters  parameters of the vehicle; spawn is `alley: 0` unless they contain
  /// "spawn: {...}"
  SmallWorld& vehicle(const std::string& name, const std::string& type,
                      const std::string& parameters = "");
  SmallWorld& vehicle(const std::string& name, PartSpec spec,
                      PartFactory<Vehicle, VehicleContext> make,
                      const std::string& parameters = "");

  /// Map of the vehicle; without it the true rows.
  SmallWorld& map(const std::string& vehicle, const std::string& type,
                  const std::string& parameters = "");
  SmallWorld& map(const std::string& vehicle, PartSpec spec, PartFactory<RowMap, MapContext> make,
                  const std::string& parameters = "");

  SmallWorld& sensor(const std::string& vehicle, const std::string& name, const std::string& type,
                     const std::string& parameters = "");
  SmallWorld& sensor(const std::string& vehicle, const std::string& name, PartSpec spec,
                     PartFactory<Sensor, SensorContext> make, const std::string& parameters = "");

  /// Estimator of the vehicle. Default: the estimate is the truth.
  SmallWorld& estimator(const std::string& vehicle, const std::string& type,
                        const std::string& parameters = "");
  SmallWorld& estimator(const std::string& vehicle, PartSpec spec,
                        PartFactory<Estimator, EstimatorContext> make,
                        const std::string& parameters = "");

  /// Adds an observer: an estimator that does not control the vehicle.
  SmallWorld& observer(const std::string& vehicle, const std::string& name, const std::string& type,
                       const std::string& parameters = "");
  SmallWorld& observer(const std::string& vehicle, const std::string& name, PartSpec spec,
                       PartFactory<Estimator, EstimatorContext> make,
                       const std::string& parameters = "");

  SmallWorld& planner(const std::string& vehicle, const std::string& type,
                      const std::string& parameters = "");
  SmallWorld& planner(const std::string& vehicle, PartSpec spec,
                      PartFactory<Planner, PlannerContext> make,
                      const std::string& parameters = "");

  /// Requires a controller: a vehicle without one is rejected.
  SmallWorld& guidance(const std::string& vehicle, const std::string& type,
                       const std::string& parameters = "");
  SmallWorld& guidance(const std::string& vehicle, PartSpec spec,
                       PartFactory<Guidance, ControllerContext> make,
                       const std::string& parameters = "");

  SmallWorld& controller(const std::string& vehicle, const std::string& type,
                         const std::string& parameters = "");
  SmallWorld& controller(const std::string& vehicle, PartSpec spec,
                         PartFactory<Controller, ControllerContext> make,
                         const std::string& parameters = "");

  SmallWorld& payload(const std::string& vehicle, const std::string& name, const std::string& type,
                      const std::string& parameters = "");
  SmallWorld& payload(const std::string& vehicle, const std::string& name, PartSpec spec,
                      PartFactory<Payload, PayloadContext> make,
                      const std::string& parameters = "");

  /// Adds a metric that judges every vehicle, in addition to all built-in metrics.
  SmallWorld& metric(PartSpec spec, PartFactory<Metric, MetricContext> make);

  /// Adds a phase of a mission (docs/concepts/missions.md) with these vehicles.
  SmallWorld& phase(const std::string& name, const std::vector<std::string>& vehicles,
                    const std::string& keys = "");
  /// Adds a phase that is a job.
  /// @param keys  of the phase, with its input products: "cloud: from build_cloud"
  SmallWorld& job(const std::string& phase, const std::string& type,
                  const std::string& parameters = "", const std::string& keys = "");
  SmallWorld& job(const std::string& phase, PartSpec spec, PartFactory<Job, JobContext> make,
                  const std::string& parameters = "", const std::string& keys = "");

  /// Loads the parts of a plug-in, by its file.
  SmallWorld& plugin(const std::filesystem::path& file);
  SmallWorld& seed(std::uint64_t seed);
  SmallWorld& physics_step_s(double step_s);
  SmallWorld& duration_s(double duration_s);

  /// Scenario text of the calls so far.
  std::string yaml() const;
  /// @throws ConfigError
  TestRun build() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow::testing
