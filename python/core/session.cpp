#include "python/core/session.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>

#include "engine/api/messages/event.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/sim/plugin_loader.h"
#include "engine/sim/simulation.h"
#include "engine/sim/vehicle_runtime.h"
#include "python/core/fields_to_python.h"
#include "python/core/message_codec.h"
#include "python/core/usage_error.h"
#include "python/core/world.h"
#include "python/core/yaml_from_python.h"
#include "tools/parts/register_all.h"

namespace vinerow::python {
namespace py = pybind11;
namespace {

/// Simulated time between two looks for Ctrl-C. Chosen: a fraction of a second of computation.
constexpr Duration kInterruptPeriod{100'000'000};

Time time_from_s(double seconds, const char* what) {
  // The limit of duration_from_s().
  if (!std::isfinite(seconds) || std::abs(seconds) > 9e9) {
    throw UsageError(fmt::format("{} = {}, must be a finite time in s", what, seconds));
  }
  return Time{} + duration_from_s(seconds);
}

scenario::Overrides overrides_from(const py::dict& values, const std::vector<std::string>& sets,
                                   std::optional<std::uint64_t> seed) {
  scenario::Overrides overrides{sets, seed};
  for (const auto& [key, value] : values) {
    if (!py::isinstance<py::str>(key)) {
      throw ConfigError(
          fmt::format("overrides has a key {}, must be a str", std::string(py::repr(key))));
    }
    const auto path = key.cast<std::string>();
    overrides.values.push_back({path, yaml_from_python(value, path)});
  }
  return overrides;
}

std::shared_ptr<LoadedScenario> load_file(const std::filesystem::path& file, const py::dict& values,
                                          const std::vector<std::string>& sets,
                                          std::optional<std::uint64_t> seed) {
  const scenario::Overrides overrides = overrides_from(values, sets, seed);
  auto registry = std::make_shared<Registry>();
  register_all(*registry);
  for (const auto& plugin : scenario::load_plugin_list(file, overrides)) {
    load_plugin(plugin, *registry);
  }
  auto loaded = std::make_shared<LoadedScenario>();
  loaded->scenario = scenario::load_scenario(file, *registry, overrides);
  loaded->registry = std::move(registry);
  return loaded;
}

std::shared_ptr<LoadedScenario> load_text(const std::string& yaml,
                                          const std::filesystem::path& folder,
                                          const py::dict& values,
                                          const std::vector<std::string>& sets,
                                          std::optional<std::uint64_t> seed) {
  auto registry = std::make_shared<Registry>();
  register_all(*registry);
  auto loaded = std::make_shared<LoadedScenario>();
  loaded->scenario =
      scenario::parse_scenario(yaml, folder, *registry, overrides_from(values, sets, seed));
  loaded->registry = std::move(registry);
  return loaded;
}

/// @param taken  signals that Python writes: names, or pairs of name and type
SessionOptions options_from(const py::iterable& taken) {
  SessionOptions options;
  for (const py::handle entry : taken) {
    std::string name, type;
    if (py::isinstance<py::str>(entry)) {
      name = entry.cast<std::string>();
      type = outside_type(name);
      if (type.empty()) {
        throw ConfigError(fmt::format(
            "take_over: the name '{0}' does not determine a type; give a pair, e.g. ('{0}', "
            "'AirReference')",
            name));
      }
    } else {
      try {
        std::tie(name, type) = entry.cast<std::pair<std::string, std::string>>();
      } catch (const py::cast_error&) {
        throw ConfigError("take_over must be names of signals, or pairs of name and type");
      }
    }
    const MessageCodec* codec = find_codec(type);
    if (!codec) throw ConfigError(fmt::format("take_over: no message type '{}'", type));
    options.outside.push_back(codec->outside(name));
  }
  return options;
}

/// vinerow.Signal: reads a signal of a session by the names of its fields.
class PythonSignal {
 public:
  PythonSignal(std::shared_ptr<PythonSession> session, std::string name)
      : session_(std::move(session)), name_(std::move(name)) {
    PythonSession::Use use(*session_);
    refresh(use);
  }

  const std::string& name() const { return name_; }
  std::string type() {
    PythonSession::Use use(*session_);
    return refresh(use).type();
  }
  std::string writer() {
    PythonSession::Use use(*session_);
    return refresh(use).writer();
  }
  std::uint64_t count() {
    PythonSession::Use use(*session_);
    const SignalBase& signal = refresh(use);
    return signal.sequence() - signal.forgotten();
  }
  Time stamp() {
    PythonSession::Use use(*session_);
    return written(use).stamp();
  }
  py::dict fields() {
    PythonSession::Use use(*session_);
    return field_infos(refresh(use));
  }
  py::object item(const std::string& field) {
    PythonSession::Use use(*session_);
    const SignalBase& signal = written(use);
    if (!owner_) {
      owner_ = py::capsule(new std::shared_ptr<const void>(use->run_memory()), [](void* memory) {
        delete static_cast<std::shared_ptr<const void>*>(memory);
      });
    }
    if (py::object value = field_to_python(signal, field, owner_, Memory::kView)) return value;
    const auto known = field_names(signal);
    throw py::key_error(fmt::format("signal '{}' has no field '{}'{} (known: {})", name_, field,
                                    did_you_mean(field, known), join(known)));
  }
  py::object value() {
    PythonSession::Use use(*session_);
    return message_to_python(written(use));
  }

 private:
  /// The signal of the session's present run.
  const SignalBase& refresh(PythonSession::Use& use) {
    if (!signal_ || run_ != session_->run_number()) {
      owner_ = py::object();
      signal_ = &use->any_signal(name_);
      run_ = session_->run_number();
    }
    return *signal_;
  }
  const SignalBase& written(PythonSession::Use& use) {
    const SignalBase& signal = refresh(use);
    if (signal.sequence() == signal.forgotten()) {
      throw UsageError(fmt::format("signal '{}' has no value yet", name_));
    }
    return signal;
  }

  std::shared_ptr<PythonSession> session_;
  std::string name_;
  const SignalBase* signal_ = nullptr;
  std::uint64_t run_ = 0;
  py::object owner_;  ///< of the memory of this run's signals
};

std::string_view level_name(Event::Level level) {
  for (const EnumName& name : enum_names(level)) {
    if (name.value == static_cast<std::int64_t>(level)) return name.name;
  }
  return "";
}

const VehicleRuntime& find_vehicle(const Session& session, const std::string& name) {
  for (const auto& vehicle : session.simulation().vehicles()) {
    if (vehicle->name() == name) return *vehicle;
  }
  const auto known = session.vehicles();
  throw ConfigError(
      fmt::format("no vehicle '{}'{} (known: {})", name, did_you_mean(name, known), join(known)));
}

py::dict phase_to_python(const SessionPhase& phase) {
  const auto seconds = [](const std::optional<Time>& t) -> py::object {
    return t ? py::object(py::float_(t->s())) : py::none();
  };
  py::dict dict;
  dict["name"] = phase.name;
  dict["state"] = phase.state;
  dict["begin_s"] = seconds(phase.begin);
  dict["end_s"] = seconds(phase.end);
  dict["reason"] = phase.reason;
  dict["numbers"] = phase.numbers;
  return dict;
}

}  // namespace

PythonSession::PythonSession(std::shared_ptr<const LoadedScenario> loaded, SessionOptions options)
    : loaded_(std::move(loaded)) {
  session_.emplace(loaded_->scenario, loaded_->registry, std::move(options));
}

PythonSession::PythonSession(std::shared_ptr<const LoadedScenario> loaded, Session session)
    : loaded_(std::move(loaded)), session_(std::move(session)) {}

PythonSession::Use::Use(PythonSession& owner) : owner_(owner) {
  if (owner_.process_ != getpid()) {
    throw UsageError(
        "the session belongs to the process that opened it; open sessions after the fork");
  }
  if (owner_.busy_.exchange(true, std::memory_order_acquire)) {
    throw UsageError("the session is in use by another thread; give each thread its own (twin())");
  }
  if (!owner_.session_) {
    owner_.busy_ = false;
    throw UsageError("the session is closed");
  }
}

void PythonSession::step(Time until) {
  Use use(*this);
  do {
    {
      py::gil_scoped_release release;
      use->advance(std::min(until, use->now() + kInterruptPeriod));
    }
    if (use->now() > until || use->over()) return;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  } while (true);
}

void PythonSession::reset(std::optional<std::uint64_t> seed) {
  Use use(*this);
  {
    py::gil_scoped_release release;
    use->reset(seed ? *seed : use->seed());
  }
  ++run_number_;
}

std::shared_ptr<PythonSession> PythonSession::twin() {
  Use use(*this);
  py::gil_scoped_release release;
  return std::make_shared<PythonSession>(loaded_, use->twin());
}

void PythonSession::close() {
  if (closed() || process_ != getpid()) return;
  {
    Use use(*this);
    py::gil_scoped_release release;
    session_.reset();
  }
  ++run_number_;
}

void bind_session(py::module_& module) {
  py::class_<LoadedScenario, std::shared_ptr<LoadedScenario>>(module, "Scenario")
      .def_property_readonly("name", [](const LoadedScenario& s) { return s.scenario.name; })
      .def_property_readonly("description",
                             [](const LoadedScenario& s) { return s.scenario.description; })
      .def_property_readonly("seed", [](const LoadedScenario& s) { return s.scenario.seed; })
      .def_property_readonly("duration_s",
                             [](const LoadedScenario& s) { return s.scenario.duration_s; })
      .def_property_readonly("physics_step_s",
                             [](const LoadedScenario& s) { return s.scenario.physics_step.s(); })
      .def_property_readonly("yaml",
                             [](const LoadedScenario& s) { return s.scenario.resolved_yaml; })
      .def_property_readonly("warnings",
                             [](const LoadedScenario& s) { return s.scenario.warnings; })
      .def_property_readonly("vehicles", [](const LoadedScenario& s) {
        std::vector<std::string> names;
        for (const auto& vehicle : s.scenario.vehicles) names.push_back(vehicle.name);
        return names;
      });
  module.def("load_file", &load_file, py::arg("file"), py::arg("overrides"), py::arg("sets"),
             py::arg("seed"));
  module.def("load_text", &load_text, py::arg("yaml"), py::arg("folder"), py::arg("overrides"),
             py::arg("sets"), py::arg("seed"));
  module.def("dict_to_yaml",
             [](const py::dict& d) { return io::to_yaml(yaml_from_python(d, "")); });

  py::class_<PythonSession, std::shared_ptr<PythonSession>>(module, "Session")
      .def(py::init([](std::shared_ptr<LoadedScenario> loaded, const py::iterable& take_over) {
             SessionOptions options = options_from(take_over);
             py::gil_scoped_release release;
             return std::make_shared<PythonSession>(std::move(loaded), std::move(options));
           }),
           py::arg("scenario"), py::arg("take_over"))
      .def(
          "step", [](PythonSession& s, double until_s) { s.step(time_from_s(until_s, "until_s")); },
          py::arg("until_s"))
      .def(
          "step_for",
          [](PythonSession& s, double duration_s) {
            Time until;
            {
              PythonSession::Use use(s);
              const Duration duration = time_from_s(duration_s, "duration_s") - Time{};
              if (duration < use->step()) {
                throw UsageError(
                    fmt::format("duration_s = {} is shorter than the physics step of {} s, in "
                                "which nothing happens",
                                duration_s, use->step().s()));
              }
              until = use->now() + duration - use->step();
            }
            s.step(until);
          },
          py::arg("duration_s"))
      .def("reset", &PythonSession::reset, py::arg("seed") = py::none())
      .def("twin", &PythonSession::twin)
      .def("close", &PythonSession::close)
      .def_property_readonly("closed", &PythonSession::closed)
      .def("__enter__", [](std::shared_ptr<PythonSession> s) { return s; })
      .def("__exit__", [](PythonSession& s, const py::args&) { s.close(); })
      .def_property_readonly("now_s",
                             [](PythonSession& s) { return PythonSession::Use(s)->now().s(); })
      .def_property_readonly("over", [](PythonSession& s) { return PythonSession::Use(s)->over(); })
      .def_property_readonly("finished",
                             [](PythonSession& s) { return PythonSession::Use(s)->finished(); })
      .def_property_readonly("seed", [](PythonSession& s) { return PythonSession::Use(s)->seed(); })
      .def_property_readonly("digest",
                             [](PythonSession& s) { return PythonSession::Use(s)->digest(); })
      .def_property_readonly("vehicles",
                             [](PythonSession& s) { return PythonSession::Use(s)->vehicles(); })
      .def("metrics", [](PythonSession& s) { return PythonSession::Use(s)->metrics(); })
      .def("signals",
           [](PythonSession& s) {
             py::dict dict;
             for (const SignalInfo& info : PythonSession::Use(s)->signals())
               dict[py::str(info.name)] = py::make_tuple(info.type, info.writer);
             return dict;
           })
      .def(
          "signal",
          [](std::shared_ptr<PythonSession> s, std::string name) {
            return PythonSignal(std::move(s), std::move(name));
          },
          py::arg("name"))
      .def(
          "command",
          [](PythonSession& s, const std::string& signal, const py::object& value,
             std::optional<double> at_s) {
            PythonSession::Use use(s);
            const MessageCodec* codec = find_codec(use->any_signal(signal).type());
            if (!codec)
              throw ConfigError(
                  fmt::format("signal '{}' is of a type that Python cannot write", signal));
            const Time stamp = at_s ? time_from_s(*at_s, "at_s") : use->now();
            use->command(codec->command(signal, stamp, value));
          },
          py::arg("signal"), py::arg("value"), py::arg("at_s") = py::none())
      .def("world",
           [](PythonSession& s) {
             return world_to_python(PythonSession::Use(s)->simulation().world());
           })
      .def(
          "map",
          [](PythonSession& s, const std::string& vehicle) {
            PythonSession::Use use(s);
            return map_to_python(find_vehicle(*use, vehicle).map());
          },
          py::arg("vehicle"))
      .def(
          "vehicle",
          [](PythonSession& s, const std::string& vehicle) {
            PythonSession::Use use(s);
            return vehicle_to_python(vehicle, find_vehicle(*use, vehicle).vehicle().description());
          },
          py::arg("vehicle"))
      .def("take_events",
           [](PythonSession& s) {
             const py::object type = py::module_::import("vinerow.messages").attr("Event");
             py::list list;
             for (const SessionEvent& event : PythonSession::Use(s)->take_events()) {
               list.append(type(event.time.s(), level_name(event.event.level), event.event.source,
                                event.event.text));
             }
             return list;
           })
      .def("crashes",
           [](PythonSession& s) {
             const py::object type = py::module_::import("vinerow.messages").attr("Crash");
             py::list list;
             for (const SessionCrash& crash : PythonSession::Use(s)->crashes())
               list.append(type(crash.vehicle, crash.time.s(), crash.text));
             return list;
           })
      .def("phases", [](PythonSession& s) {
        py::list list;
        for (const SessionPhase& phase : PythonSession::Use(s)->phases())
          list.append(phase_to_python(phase));
        return list;
      });

  py::class_<PythonSignal>(module, "Signal")
      .def_property_readonly("name", &PythonSignal::name)
      .def_property_readonly("type", &PythonSignal::type)
      .def_property_readonly("writer", &PythonSignal::writer)
      .def_property_readonly("count", &PythonSignal::count)
      .def_property_readonly("stamp_s", [](PythonSignal& s) { return s.stamp().s(); })
      .def_property_readonly("fields", &PythonSignal::fields)
      .def_property_readonly("value", &PythonSignal::value)
      .def("__getitem__", &PythonSignal::item, py::arg("field"));
}

}  // namespace vinerow::python
