#pragma once
/// Test a controller against physics: build a tiny world, put a vehicle and a controller in it,
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
/// Part parameters are given as the inside of a YAML mapping, with the keys of scenario files:
/// "lookahead_m: 0.5, rate_Hz: 20". Everything is checked as in a file: a ConfigError says what is
/// wrong. No files are written. Needs no GoogleTest.

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/messages.h"
#include "engine/api/registry.h"

namespace vinerow {
class Simulation;
}

namespace vinerow::testing {

/// A run in memory that a test steps and asks.
class TestRun {
 public:
  /// A scenario file. @param sets  overrides as on the command line,
  /// "rover.controller.lookahead_m=0.5"
  static TestRun from_file(const std::filesystem::path& file,
                           const std::vector<std::string>& sets = {});
  /// A scenario text. @param folder  where its relative paths start
  static TestRun from_yaml(const std::string& yaml, const std::filesystem::path& folder = ".");
  ~TestRun();
  TestRun(TestRun&&) noexcept;
  TestRun& operator=(TestRun&&) noexcept;

  /// Steps on by this much simulated time, or to the end of the mission. @throws SimulationError
  TestRun& run_for_s(double duration_s);
  TestRun& run_to_end();

  double time_s() const;
  /// Every controller said that it has finished.
  bool finished() const;
  /// Metric so far. @throws ConfigError with the nearest name for an unknown vehicle or metric
  double metric(const std::string& vehicle, const std::string& name) const;
  std::map<std::string, double> metrics(const std::string& vehicle) const;
  /// True pose and twist at the last instant.
  const Odometry& truth(const std::string& vehicle) const;
  /// Last value of any signal, e.g. signal<FollowerState>("rover/follower").
  /// @throws ConfigError if there is none, it has another type, or was never written
  template <class T>
  const T& signal(const std::string& name) const;
  std::string digest() const;
  Simulation& simulation();

 private:
  friend class SmallWorld;
  TestRun(std::shared_ptr<Registry> registry, std::unique_ptr<Simulation> simulation);

  std::shared_ptr<Registry> registry_;  // outlives the simulation's parts
  std::unique_ptr<Simulation> simulation_;
};

/// Builds a TestRun: by default a flat block of two 20 m rows, 2.5 m apart, with one alley between
/// them, and a physics step of 1 ms. Every call returns the builder.
class SmallWorld {
 public:
  SmallWorld();
  ~SmallWorld();
  SmallWorld(SmallWorld&&) noexcept;
  SmallWorld& operator=(SmallWorld&&) noexcept;

  /// Another world. @param parameters  inside of a YAML mapping
  SmallWorld& world(const std::string& type, const std::string& parameters = "");
  /// @param parameters  of the vehicle; spawn is `alley: 0` unless given as "spawn: {...}" among
  /// them
  SmallWorld& vehicle(const std::string& name, const std::string& type,
                      const std::string& parameters = "");
  SmallWorld& sensor(const std::string& vehicle, const std::string& name, const std::string& type,
                     const std::string& parameters = "");
  SmallWorld& estimator(const std::string& vehicle, const std::string& type,
                        const std::string& parameters = "");
  SmallWorld& planner(const std::string& vehicle, const std::string& type,
                      const std::string& parameters = "");
  SmallWorld& controller(const std::string& vehicle, const std::string& type,
                         const std::string& parameters = "");
  /// A controller class of your own, without a plug-in.
  SmallWorld& controller(const std::string& vehicle, PartSpec spec,
                         PartFactory<Controller, ControllerContext> make,
                         const std::string& parameters = "");
  /// Parts of a plug-in, by its file.
  SmallWorld& plugin(const std::filesystem::path& file);
  SmallWorld& seed(std::uint64_t seed);
  SmallWorld& physics_step_s(double step_s);
  SmallWorld& duration_s(double duration_s);

  /// The scenario text that the calls so far amount to.
  std::string yaml() const;
  /// @throws ConfigError
  TestRun build() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow::testing
