#include "python/tasks/vector_environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"

namespace vinerow::tasks {

VectorEnvironment::VectorEnvironment(std::shared_ptr<const EnvironmentSetup> setup, int count,
                                     int threads, Autoreset autoreset)
    : autoreset_(autoreset), workers_(std::min(threads, count)) {
  check_setup(*setup);
  for (int i = 0; i < count; ++i) {
    environments_.push_back(std::make_unique<Environment>(setup));
    environments_.back()->seed(static_cast<std::uint64_t>(i));
  }
  const auto rows = static_cast<std::size_t>(count);
  arrays_.observations.assign(rows * task().observation().size(), 0.0F);
  arrays_.final_observations = arrays_.observations;
  arrays_.numbers.assign(rows * task().numbers().size(), 0.0);
  arrays_.final_numbers = arrays_.numbers;
  arrays_.rewards.assign(rows, 0.0);
  arrays_.terminated.assign(rows, 0);
  arrays_.truncated = arrays_.succeeded = arrays_.ended = arrays_.terminated;
}

void VectorEnvironment::reset(const std::vector<std::optional<std::uint64_t>>& seeds,
                              const std::vector<std::uint8_t>& chosen) {
  workers_.run(size(), [&](int i) {
    if (!chosen.empty() && !chosen[i]) return;
    Environment& environment = *environments_[i];
    if (seeds[i]) environment.seed(*seeds[i]);
    environment.reset();
    arrays_.ended[i] = 0;
    store(i);
  });
}

void VectorEnvironment::store(int index) {
  const Environment::Agent& agent = environments_[index]->agents().front();
  std::copy(
      agent.observation.begin(), agent.observation.end(),
      arrays_.observations.begin() + static_cast<std::ptrdiff_t>(index * agent.observation.size()));
  std::copy(agent.numbers.begin(), agent.numbers.end(),
            arrays_.numbers.begin() + static_cast<std::ptrdiff_t>(index * agent.numbers.size()));
  arrays_.rewards[index] = agent.judgement.reward;
  arrays_.terminated[index] = agent.judgement.terminated;
  arrays_.truncated[index] = agent.truncated;
  arrays_.succeeded[index] = agent.judgement.succeeded;
}

void VectorEnvironment::step(std::span<const float> actions) {
  const std::size_t width = task().action().size();
  for (std::size_t i = 0; i < actions.size(); ++i) {
    if (std::isfinite(actions[i])) continue;
    throw ConfigError(fmt::format("the action of environment {} is {} in its element {} ('{}')",
                                  i / width, actions[i], i % width,
                                  task().action()[i % width].name));
  }
  workers_.run(size(), [&](int i) {
    step_one(i, actions.subspan(static_cast<std::size_t>(i) * width, width));
  });
}

void VectorEnvironment::step_one(int index, std::span<const float> action) {
  Environment& environment = *environments_[index];
  arrays_.ended[index] = 0;
  if (environment.done()) {  // only with kNextStep
    environment.reset();
    store(index);
    return;
  }
  Environment::Agent& agent = environment.agents().front();
  for (std::size_t i = 0; i < action.size(); ++i) {
    agent.action[i] = std::clamp(action[i], -1.0F, 1.0F);
  }
  environment.step();
  store(index);
  if (autoreset_ != Autoreset::kSameStep || !environment.done()) return;

  arrays_.ended[index] = 1;
  const auto row = static_cast<std::ptrdiff_t>(index);
  std::copy(agent.observation.begin(), agent.observation.end(),
            arrays_.final_observations.begin() +
                row * static_cast<std::ptrdiff_t>(agent.observation.size()));
  std::copy(
      agent.numbers.begin(), agent.numbers.end(),
      arrays_.final_numbers.begin() + row * static_cast<std::ptrdiff_t>(agent.numbers.size()));
  const Judgement last = agent.judgement;
  const bool truncated = agent.truncated;
  environment.reset();
  store(index);
  arrays_.rewards[index] = last.reward;
  arrays_.terminated[index] = last.terminated;
  arrays_.truncated[index] = truncated;
  arrays_.succeeded[index] = last.succeeded;
}

}  // namespace vinerow::tasks
