#include "python/tasks/environment.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.h"

namespace vinerow::tasks {

void check_setup(const EnvironmentSetup& setup) {
  const scenario::Scenario scenario = setup.source->load(*setup.registry, setup.overrides);
  if (setup.period.ns % scenario.physics_step.ns != 0) {
    throw ConfigError(fmt::format(
        "the period of an action, {:g} s, is not a whole number of physics steps of {:g} s",
        setup.period.s(), scenario.physics_step.s()));
  }
  for (const AgentSetup& agent : setup.agents) static_cast<void>(task_spec(agent.task));
}

Environment::Environment(std::shared_ptr<const EnvironmentSetup> setup)
    : setup_(std::move(setup)), level_(setup_->factors.size(), 0) {
  for (const AgentSetup& wanted : setup_->agents) {
    Agent& agent = agents_.emplace_back();
    agent.name = wanted.vehicle;
    agent.task = make_task(wanted.task, wanted.parameters, {wanted.vehicle, setup_->period.s()});
    agent.observation.assign(agent.task->observation().size(), 0.0F);
    agent.action.assign(agent.task->action().size(), 0.0F);
    agent.numbers.assign(agent.task->numbers().size(), 0.0);
  }
}

bool Environment::done() const {
  return std::all_of(agents_.begin(), agents_.end(),
                     [](const Agent& agent) { return agent.done(); });
}

std::vector<std::pair<std::string, std::string>> Environment::levels() const {
  std::vector<std::pair<std::string, std::string>> all;
  for (std::size_t i = 0; i < level_.size(); ++i) {
    const scenario::Factor& factor = setup_->factors[i];
    for (std::size_t column = 0; column < factor.columns.size(); ++column) {
      all.emplace_back(factor.columns[column], factor.levels[level_[i]].texts[column]);
    }
  }
  return all;
}

void Environment::open(std::uint64_t seed) {
  if (session_ && setup_->factors.empty()) {
    session_->reset(seed);
    return;
  }
  scenario::Overrides overrides = setup_->overrides;
  overrides.seed = seed;
  for (std::size_t i = 0; i < level_.size(); ++i) {
    const auto& values = setup_->factors[i].levels[level_[i]].values;
    overrides.values.insert(overrides.values.end(), values.begin(), values.end());
  }
  SessionOptions options;
  options.shelf = setup_->shelf;
  for (const Agent& agent : agents_) options.outside.push_back(agent.task->taken_over());
  const scenario::Scenario scenario = setup_->source->load(*setup_->registry, overrides);
  session_.emplace(scenario, setup_->registry, std::move(options));
}

void Environment::reset() {
  // The draws do not depend on the number of steps of the last episode.
  const std::uint64_t seed = stream_.next_u64() >> 1;
  for (std::size_t i = 0; i < level_.size(); ++i) {
    const auto count = setup_->factors[i].levels.size();
    level_[i] = std::min(static_cast<std::size_t>(stream_.uniform() * static_cast<double>(count)),
                         count - 1);
  }
  open(seed);
  for (Agent& agent : agents_) {
    agent.judgement = {};
    agent.truncated = false;
    agent.task->begin(*session_);
  }
  for (Agent& agent : agents_) observe(agent);
  if (pictures_) pictures_->begin(*session_);
}

void Environment::observe(Agent& agent) {
  agent.task->observe(agent.observation);
  agent.task->measure(agent.numbers);
}

void Environment::step() {
  for (Agent& agent : agents_) {
    if (agent.done()) {
      const auto& elements = agent.task->action();
      for (std::size_t i = 0; i < elements.size(); ++i) agent.action[i] = 0.0F;
    }
    agent.task->act(*session_, agent.action);
  }
  session_->advance_for(setup_->period);
  for (Agent& agent : agents_) {
    if (agent.done()) {
      agent.judgement.reward = 0.0;
      continue;
    }
    agent.judgement = agent.task->judge(*session_);
    agent.truncated = session_->over() && !agent.judgement.terminated;
    observe(agent);
  }
  if (pictures_) pictures_->note(*session_);
}

}  // namespace vinerow::tasks
