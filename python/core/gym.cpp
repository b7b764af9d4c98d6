#include "python/core/gym.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cmath>
#include <utility>

#include "engine/core/error.h"
#include "engine/scenario/scenario_reader.h"
#include "engine/scenario/study_factor.h"
#include "python/core/arguments.h"
#include "python/core/guard.h"
#include "python/core/parts.h"
#include "python/core/run.h"
#include "python/core/scenario.h"
#include "python/core/yaml_from_python.h"
#include "python/tasks/vector_environment.h"

namespace vinerow::python {
namespace py = pybind11;
namespace {

using tasks::AgentSetup;
using tasks::Environment;
using tasks::EnvironmentSetup;
using tasks::VectorEnvironment;

using Values = Typed<"dict[str, typing.Any]">;
using Texts = Typed<"dict[str, str]">;
using Elements = Typed<"list[tuple[str, float, float]]">;
using AgentState = Typed<"tuple[typing.Any, float, bool, bool, dict[str, typing.Any]]">;

using ActionArray = py::array_t<float, py::array::c_style | py::array::forcecast>;

AgentSetup agent_from(const std::string& vehicle, const std::string& task, const Values& options) {
  const auto& specs = tasks::task_spec(task).parameters;
  const io::YamlNode node = yaml_from_python(options, "");
  const std::string owner = fmt::format("task '{}'", task);
  scenario::check_keys(node, "options", scenario::names_of(specs), owner, nullptr);
  return {vehicle, task, scenario::read_parameters(node, {}, "options", specs, owner).values};
}

std::shared_ptr<EnvironmentSetup> make_setup(const std::string& file, const Values& values,
                                             const std::vector<std::string>& sets,
                                             const Values& factors, double period_s) {
  auto setup = std::make_shared<EnvironmentSetup>();
  setup->overrides = overrides_from_python(values, sets, std::nullopt);
  setup->registry = registry_with(scenario::load_plugin_list(file, setup->overrides));
  setup->source = std::make_shared<scenario::ScenarioSource>(file);
  setup->factors = scenario::read_factors(yaml_from_python(factors, "factors"));
  if (!(period_s > 0.0) || !(period_s <= 10.0)) {
    throw ConfigError(fmt::format("period_s = {}, must be > 0 s and <= 10 s", period_s));
  }
  setup->period = duration_from_s(period_s);
  // Worlds of a few recent episodes; more would take their memory.
  constexpr std::size_t kWorlds = 8;
  setup->shelf = std::make_shared<RunShelf>(kWorlds);
  return setup;
}

Elements elements_to_python(const std::vector<tasks::Element>& elements) {
  py::list list;
  for (const auto& element : elements) {
    list.append(py::make_tuple(element.name, element.low, element.high));
  }
  return list;
}

/// A copy of rows of numbers. @param width  of a row; 0: one number per row, one axis
template <class T>
py::array_t<T> rows_of(const std::vector<T>& values, std::size_t rows, std::size_t width) {
  if (width == 0) return py::array_t<T>(static_cast<py::ssize_t>(rows), values.data());
  return py::array_t<T>({rows, width}, values.data());
}

py::array_t<bool> flags_of(const std::vector<std::uint8_t>& flags) {
  py::array_t<bool> array(static_cast<py::ssize_t>(flags.size()));
  std::copy(flags.begin(), flags.end(), array.mutable_data());
  return array;
}

/// An action as Python gave it. @throws ConfigError on a wrong shape or type
ActionArray checked_actions(const py::object& given, const std::vector<std::size_t>& shape,
                            const std::string& what) {
  const auto text = [](const auto& sizes) {
    std::string joined = "(";
    for (const auto size : sizes) joined += fmt::format("{}{}", joined == "(" ? "" : ", ", size);
    return joined + (sizes.size() == 1 ? ",)" : ")");
  };
  const py::array array = py::array::ensure(given);
  const char kind = array ? array.dtype().kind() : 'O';
  if (kind != 'f' && kind != 'i' && kind != 'u') {
    PyErr_Clear();
    throw ConfigError(
        fmt::format("{} must be numbers, not {}", what,
                    array ? std::string(py::str(array.dtype()))
                          : std::string(py::str(py::type::handle_of(given).attr("__name__")))));
  }
  const std::vector<py::ssize_t> sizes(array.shape(), array.shape() + array.ndim());
  if (!std::equal(sizes.begin(), sizes.end(), shape.begin(), shape.end(),
                  [](py::ssize_t a, std::size_t b) { return a == static_cast<py::ssize_t>(b); })) {
    throw ConfigError(
        fmt::format("{} must have the shape {}, not {}", what, text(shape), text(sizes)));
  }
  return ActionArray::ensure(array);
}

Texts levels_to_python(const Environment& environment) {
  py::dict levels;
  for (const auto& [name, text] : environment.levels()) levels[py::str(name)] = text;
  return levels;
}

Values numbers_to_python(const Environment::Agent& agent) {
  py::dict numbers;
  const auto& names = agent.task->numbers();
  for (std::size_t i = 0; i < names.size(); ++i) numbers[py::str(names[i])] = agent.numbers[i];
  numbers["succeeded"] = agent.judgement.succeeded;
  return numbers;
}

const Session& session_of(const Environment& environment) {
  if (!environment.session()) throw UsageError("reset() comes first: no episode has begun");
  return *environment.session();
}

constexpr Guard::Sentences kEnvironmentSentences = {
    "the environment belongs to the process that made it; make environments after the fork",
    "the environment is in use by another thread; give each thread its own"};

/// Environments with one agent each.
class Environments {
 public:
  Environments(std::shared_ptr<EnvironmentSetup> setup, int count, int threads,
               tasks::Autoreset autoreset)
      : environments_(
            std::make_unique<VectorEnvironment>(std::move(setup), count, threads, autoreset)) {}
  ~Environments() {
    // The threads exist only in the process that made them.
    if (!guard_.in_own_process()) static_cast<void>(environments_.release());
  }
  Environments(const Environments&) = delete;
  Environments& operator=(const Environments&) = delete;

  VectorEnvironment& get() {
    if (!environments_) throw UsageError("the environment is closed");
    return *environments_;
  }
  Guard& guard() { return guard_; }
  void close() {
    if (!guard_.in_own_process()) return;
    const Guard::Use use(guard_);
    environments_.reset();
  }

 private:
  Guard guard_{kEnvironmentSentences};
  std::unique_ptr<VectorEnvironment> environments_;
};

tasks::Autoreset autoreset_of(const std::string& name) {
  if (name == "next_step") return tasks::Autoreset::kNextStep;
  if (name == "same_step") return tasks::Autoreset::kSameStep;
  if (name == "disabled") return tasks::Autoreset::kDisabled;
  throw ConfigError(
      fmt::format("autoreset_mode = '{}', must be one of: next_step, same_step, disabled", name));
}

std::unique_ptr<Environments> make_environments(const std::string& file, const Values& values,
                                                const std::vector<std::string>& sets,
                                                const Values& factors, const std::string& vehicle,
                                                const std::string& task, const Values& options,
                                                double period_s, int count, int threads,
                                                const std::string& autoreset) {
  constexpr int kMaxCount = 100'000, kMaxThreads = 1024;
  if (count < 1 || count > kMaxCount) {
    throw ConfigError(fmt::format("num_envs = {}, must be 1 to {}", count, kMaxCount));
  }
  if (threads < 1 || threads > kMaxThreads) {
    throw ConfigError(fmt::format("threads = {}, must be 1 to {}", threads, kMaxThreads));
  }
  auto setup = make_setup(file, values, sets, factors, period_s);
  setup->agents.push_back(agent_from(vehicle, task, options));
  return std::make_unique<Environments>(std::move(setup), count, threads, autoreset_of(autoreset));
}

void reset(Environments& self, const std::vector<std::optional<std::uint64_t>>& seeds,
           const std::vector<bool>& chosen) {
  const Guard::Use use(self.guard());
  VectorEnvironment& environments = self.get();
  const std::vector<std::uint8_t> flags(chosen.begin(), chosen.end());
  without_lock([&] { environments.reset(seeds, flags); });
}

/// @throws UsageError before the first reset, or, without autoreset, if an episode is over
void require_episodes(const VectorEnvironment& environments) {
  for (int i = 0; i < environments.size(); ++i) {
    const Environment& environment = environments.environment(i);
    if (!environment.session()) throw UsageError("reset() comes before the first step()");
    if (environments.autoreset() == tasks::Autoreset::kDisabled && environment.done()) {
      throw UsageError(
          fmt::format("the episode of environment {} is over; reset() begins the next one", i));
    }
  }
}

void step(Environments& self, const py::object& actions) {
  const Guard::Use use(self.guard());
  VectorEnvironment& environments = self.get();
  const std::size_t width = environments.task().action().size();
  const ActionArray array =
      checked_actions(actions, {static_cast<std::size_t>(environments.size()), width}, "actions");
  require_episodes(environments);
  without_lock([&] { environments.step({array.data(), static_cast<std::size_t>(array.size())}); });
}

/// (observations, rewards, terminated, truncated), copies
Typed<"tuple[typing.Any, typing.Any, typing.Any, typing.Any]"> results(Environments& self) {
  const VectorEnvironment& environments = self.get();
  const VectorEnvironment::Arrays& arrays = environments.arrays();
  const auto rows = static_cast<std::size_t>(environments.size());
  return py::make_tuple(
      rows_of(arrays.observations, rows, environments.task().observation().size()),
      rows_of(arrays.rewards, rows, 0), flags_of(arrays.terminated), flags_of(arrays.truncated));
}

Values numbers(Environments& self) {
  const VectorEnvironment& environments = self.get();
  const VectorEnvironment::Arrays& arrays = environments.arrays();
  const auto rows = static_cast<std::size_t>(environments.size());
  const std::size_t width = environments.task().numbers().size();
  py::dict dict;
  dict["numbers"] = rows_of(arrays.numbers, rows, width);
  dict["succeeded"] = flags_of(arrays.succeeded);
  dict["ended"] = flags_of(arrays.ended);
  dict["final_observations"] =
      rows_of(arrays.final_observations, rows, environments.task().observation().size());
  dict["final_numbers"] = rows_of(arrays.final_numbers, rows, width);
  return dict;
}

/// One action of the only environment: (observation, reward, terminated, truncated, numbers).
AgentState step_single(Environments& self, const py::object& action) {
  const Guard::Use use(self.guard());
  VectorEnvironment& environments = self.get();
  const ActionArray array =
      checked_actions(action, {environments.task().action().size()}, "the action");
  require_episodes(environments);
  without_lock([&] { environments.step({array.data(), static_cast<std::size_t>(array.size())}); });
  const Environment::Agent& agent = environments.environment(0).agents().front();
  return py::make_tuple(py::array_t<float>(static_cast<py::ssize_t>(agent.observation.size()),
                                           agent.observation.data()),
                        agent.judgement.reward, agent.judgement.terminated, agent.truncated,
                        numbers_to_python(agent));
}

/// One session with several agents.
class Episodes {
 public:
  Episodes(std::shared_ptr<EnvironmentSetup> setup) : environment_(check(std::move(setup))) {}

  Guard& guard() { return guard_; }
  Environment& environment() { return environment_; }

 private:
  static std::shared_ptr<EnvironmentSetup> check(std::shared_ptr<EnvironmentSetup> setup) {
    tasks::check_setup(*setup);
    return setup;
  }
  Guard guard_{kEnvironmentSentences};
  Environment environment_;
};

std::unique_ptr<Episodes> make_episodes(
    const std::string& file, const Values& values, const std::vector<std::string>& sets,
    const Values& factors, const Typed<"list[tuple[str, str, dict[str, typing.Any]]]">& agents,
    double period_s) {
  auto setup = make_setup(file, values, sets, factors, period_s);
  for (const py::handle agent : py::list(agents)) {
    const auto [vehicle, task, options] =
        agent.cast<std::tuple<std::string, std::string, py::dict>>();
    setup->agents.push_back(agent_from(vehicle, task, options));
  }
  return std::make_unique<Episodes>(std::move(setup));
}

void reset_episode(Episodes& self, std::optional<std::uint64_t> seed) {
  const Guard::Use use(self.guard());
  without_lock([&] {
    if (seed) self.environment().seed(*seed);
    self.environment().reset();
  });
}

void step_episode(Episodes& self, const Values& given) {
  const py::dict actions(given);
  const Guard::Use use(self.guard());
  Environment& environment = self.environment();
  static_cast<void>(session_of(environment));
  for (Environment::Agent& agent : environment.agents()) {
    if (agent.done()) continue;
    const py::str name(agent.name);
    if (!actions.contains(name)) {
      throw ConfigError(fmt::format("there is no action for agent '{}'", agent.name));
    }
    const ActionArray array = checked_actions(actions[name], {agent.action.size()},
                                              fmt::format("the action of '{}'", agent.name));
    for (std::size_t i = 0; i < agent.action.size(); ++i) {
      const float value = array.data()[i];
      if (!std::isfinite(value)) {
        throw ConfigError(fmt::format("the action of '{}' is {} in its element {} ('{}')",
                                      agent.name, value, i, agent.task->action()[i].name));
      }
      agent.action[i] = std::clamp(value, -1.0F, 1.0F);
    }
  }
  without_lock([&] { environment.step(); });
}

/// @throws ConfigError
playback::PictureChoice choice_of(const TextArgument& camera, int width, int height) {
  check_side("width", width);
  check_side("height", height);
  return {camera.value("camera"), width, height};
}

py::array_t<std::uint8_t> draw(const Environment& environment) {
  static_cast<void>(session_of(environment));
  render::Image image;
  {
    const py::gil_scoped_release release;
    image = environment.draw();
  }
  return pixels_of(image);
}

/// {agent: (observation, reward, terminated, truncated, numbers)}
Typed<"dict[str, tuple[typing.Any, float, bool, bool, dict[str, typing.Any]]]"> agents_to_python(
    Episodes& self) {
  py::dict all;
  for (const Environment::Agent& agent : self.environment().agents()) {
    all[py::str(agent.name)] =
        py::make_tuple(py::array_t<float>(static_cast<py::ssize_t>(agent.observation.size()),
                                          agent.observation.data()),
                       agent.judgement.reward, agent.judgement.terminated, agent.truncated,
                       numbers_to_python(agent));
  }
  return all;
}

Typed<"list[dict[str, typing.Any]]"> specs_to_python() {
  py::list list;
  for (const tasks::TaskSpec& spec : tasks::task_specs()) {
    py::list parameters;
    for (const ParameterSpec& parameter : spec.parameters) {
      parameters.append(py::make_tuple(parameter.name, parameter.unit,
                                       std::get<double>(parameter.default_value),
                                       scenario::allowed_text(parameter), parameter.description));
    }
    const auto task =
        tasks::make_task(spec.name, ParameterSet(spec.parameters, spec.name), {"", 0.02});
    py::dict dict;
    dict["name"] = spec.name;
    dict["description"] = spec.description;
    dict["parameters"] = parameters;
    dict["observation"] = elements_to_python(task->observation());
    dict["action"] = elements_to_python(task->action());
    dict["numbers"] = task->numbers();
    list.append(dict);
  }
  return list;
}

}  // namespace

void bind_gym(py::module_& module) {
  module.def("task_specs", &specs_to_python,
             "List of dicts: name, description, parameters, observation, action, numbers.");
  module.def(
      "check_task", [](const std::string& name) { static_cast<void>(tasks::task_spec(name)); },
      py::arg("name"), "Raises ConfigError on an unknown task.");
  py::class_<Environments>(module, "Environments", "Environments with one agent each.")
      .def(py::init(&make_environments), py::arg("file"), py::arg("overrides"), py::arg("sets"),
           py::arg("factors"), py::arg("vehicle"), py::arg("task"), py::arg("options"),
           py::arg("period_s"), py::arg("count"), py::arg("threads"), py::arg("autoreset"))
      .def_property_readonly(
          "observation",
          [](Environments& self) { return elements_to_python(self.get().task().observation()); },
          "List of (name, low, high).")
      .def_property_readonly(
          "action",
          [](Environments& self) { return elements_to_python(self.get().task().action()); },
          "List of (name, low, high).")
      .def_property_readonly("number_names",
                             [](Environments& self) { return self.get().task().numbers(); })
      .def("reset", &reset, py::arg("seeds"), py::arg("chosen"))
      .def(
          "watch",
          [](Environments& self, const TextArgument& camera, int width, int height) {
            self.get().environment(0).watch(choice_of(camera, width, height));
          },
          py::arg("camera"), py::arg("width"), py::arg("height"),
          "Lets draw() picture the first environment, from its next reset on.")
      .def("draw",
           [](Environments& self) {
             const Guard::Use use(self.guard());
             return draw(self.get().environment(0));
           })
      .def("step", &step, py::arg("actions"), "actions: (environments, elements), finite")
      .def("step_single", &step_single, py::arg("action"))
      .def("results", &results)
      .def("numbers", &numbers)
      .def("numbers_of",
           [](Environments& self, int index) {
             return numbers_to_python(self.get().environment(index).agents().front());
           })
      .def("levels", [](Environments& self,
                        int index) { return levels_to_python(self.get().environment(index)); })
      .def("digest", [](Environments& self,
                        int index) { return session_of(self.get().environment(index)).digest(); })
      .def("now_s",
           [](Environments& self, int index) {
             return session_of(self.get().environment(index)).now().nearest_s();
           })
      .def("run_seed", [](Environments& self,
                          int index) { return session_of(self.get().environment(index)).seed(); })
      .def("close", &Environments::close);
  py::class_<Episodes>(module, "Episodes", "One session with several agents.")
      .def(py::init(&make_episodes), py::arg("file"), py::arg("overrides"), py::arg("sets"),
           py::arg("factors"), py::arg("agents"), py::arg("period_s"))
      .def(
          "spaces",
          [](Episodes & self) -> Typed<"dict[str, tuple[list[tuple[str, float, float]], "
                                       "list[tuple[str, float, float]]]]"> {
            py::dict all;
            for (const Environment::Agent& agent : self.environment().agents()) {
              all[py::str(agent.name)] =
                  py::make_tuple(elements_to_python(agent.task->observation()),
                                 elements_to_python(agent.task->action()));
            }
            return all;
          })
      .def(
          "watch",
          [](Episodes& self, const TextArgument& camera, int width, int height) {
            self.environment().watch(choice_of(camera, width, height));
          },
          py::arg("camera"), py::arg("width"), py::arg("height"),
          "Lets draw() picture the episodes from the next reset on.")
      .def("draw",
           [](Episodes& self) {
             const Guard::Use use(self.guard());
             return draw(self.environment());
           })
      .def("reset", &reset_episode, py::arg("seed"))
      .def("step", &step_episode, py::arg("actions"))
      .def("agents", &agents_to_python)
      .def("levels", [](Episodes& self) { return levels_to_python(self.environment()); })
      .def("digest", [](Episodes& self) { return session_of(self.environment()).digest(); })
      .def("now_s",
           [](Episodes& self) { return session_of(self.environment()).now().nearest_s(); });
}

}  // namespace vinerow::python
