#pragma once
/// Episodes of one session: agents with their tasks, and what varies between episodes.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/random.h"
#include "engine/playback/session_pictures.h"
#include "engine/scenario/scenario.h"
#include "engine/scenario/study.h"
#include "engine/sim/run_shelf.h"
#include "engine/sim/session.h"
#include "python/tasks/task.h"

namespace vinerow::tasks {

/// An agent: a vehicle with its task.
struct AgentSetup {
  std::string vehicle;
  std::string task;
  ParameterSet parameters;
};

/// What all environments of one kind share. Immutable.
struct EnvironmentSetup {
  std::shared_ptr<const scenario::ScenarioSource> source;
  std::shared_ptr<const Registry> registry;
  scenario::Overrides overrides;
  /// In each episode, every factor has one of its levels, drawn with equal probability.
  std::vector<scenario::Factor> factors;
  std::vector<AgentSetup> agents;
  Duration period;  ///< between two actions; a multiple of the physics step
  std::shared_ptr<RunShelf> shelf;
};

/// Checks the setup without a session. @throws ConfigError
void check_setup(const EnvironmentSetup& setup);

class Environment {
 public:
  /// One agent in the present episode.
  struct Agent {
    std::string name;  ///< of its vehicle
    std::unique_ptr<Task> task;
    std::vector<float> observation;
    std::vector<float> action;    ///< limited to its bounds
    std::vector<double> numbers;  ///< as Task::numbers()
    Judgement judgement;
    bool truncated = false;
    bool done() const { return judgement.terminated || truncated; }
  };

  /// Builds the tasks; the session comes with the first reset. @throws ConfigError
  explicit Environment(std::shared_ptr<const EnvironmentSetup> setup);

  /// The episodes from the next reset() on depend on this seed alone.
  void seed(std::uint64_t seed) { stream_ = RandomStream(seed, "gym", "episode"); }
  /// Begins an episode. @throws ConfigError, SimulationError
  void reset();
  /// One period. Agents that are done rest. @pre an episode has begun and some agent is not done
  /// @throws SimulationError, ConfigError
  void step();

  /// Keeps what pictures of the episodes from the next reset() on need.
  void watch(playback::PictureChoice choice) { pictures_.emplace(setup_->registry, choice); }
  /// The present instant. @pre watch() came before the episode's reset()
  render::Image draw() const { return pictures_->draw(); }

  /// An episode runs: reset() was called and an agent is not done.
  bool running() const { return session_ && !done(); }
  bool done() const;
  std::vector<Agent>& agents() { return agents_; }
  const std::vector<Agent>& agents() const { return agents_; }
  /// Null before the first reset.
  const Session* session() const { return session_ ? &*session_ : nullptr; }
  /// Names and texts of the factors' present levels.
  std::vector<std::pair<std::string, std::string>> levels() const;

 private:
  void open(std::uint64_t seed);
  void observe(Agent& agent);

  std::shared_ptr<const EnvironmentSetup> setup_;
  RandomStream stream_{0, "gym", "episode"};
  std::vector<std::size_t> level_;  ///< of each factor
  std::optional<Session> session_;
  std::vector<Agent> agents_;
  std::optional<playback::SessionPictures> pictures_;
};

}  // namespace vinerow::tasks
