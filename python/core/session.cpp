#include "python/core/session.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/api/messages/event.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/sim/simulation.h"
#include "engine/sim/vehicle_runtime.h"
#include "python/core/arguments.h"
#include "python/core/message_codec.h"
#include "python/core/parts.h"
#include "python/core/signal.h"
#include "python/core/usage_error.h"
#include "python/core/world.h"

namespace vinerow::python {
namespace py = pybind11;
namespace {

/// Simulated time between two checks for Ctrl-C. Chosen: a fraction of a second of computation.
constexpr Duration kInterruptPeriod{100'000'000};

Duration duration_of(const NumberArgument& argument, const char* what) {
  const double seconds = argument.value(what);
  // The limit of duration_from_s().
  if (!std::isfinite(seconds) || std::abs(seconds) > 9e9) {
    throw UsageError(fmt::format("{} = {}, must be a finite time in s", what, seconds));
  }
  return duration_from_s(seconds);
}

Time time_of(const NumberArgument& argument, const char* what) {
  return Time{} + duration_of(argument, what);
}

/// @param entry  name of a signal, or a pair of name and message type
OutsideSignal taken_over(const py::handle& entry) {
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
  return codec->outside(name);
}

std::shared_ptr<PythonSession> open(const Typed<"Scenario">& scenario,
                                    const Typed<"typing.Iterable[typing.Any]">& take_over) {
  if (!py::isinstance<LoadedScenario>(scenario)) {
    throw ConfigError(
        fmt::format("scenario must be a Scenario, not {}; vinerow.open() takes files and dicts",
                    type_name_of(scenario)));
  }
  const auto loaded = scenario.cast<std::shared_ptr<LoadedScenario>>();
  if (!py::isinstance<py::iterable>(take_over)) {
    throw ConfigError(
        fmt::format("take_over must be a list of signals, not {}", type_name_of(take_over)));
  }
  SessionOptions options;
  for (const py::handle entry : take_over) options.outside.push_back(taken_over(entry));
  return without_lock([&] {
    return std::make_shared<PythonSession>(
        Session(loaded->scenario, loaded->registry, std::move(options)));
  });
}

void command(PythonSession& session, const TextArgument& name, const py::object& value,
             const std::optional<NumberArgument>& at_s) {
  const std::string signal = name.value("signal");
  PythonSession::Use use(session);
  const MessageCodec* codec = find_codec(use->any_signal(signal).type());
  if (!codec) {
    throw ConfigError(fmt::format("signal '{}' is of a type that Python cannot write", signal));
  }
  const Time stamp = at_s ? time_of(*at_s, "at_s") : use->now();
  use->command(codec->command(signal, stamp, value));
}

const VehicleRuntime& find_vehicle(const Session& session, const std::string& name) {
  for (const auto& vehicle : session.simulation().vehicles()) {
    if (vehicle->name() == name) return *vehicle;
  }
  const auto known = session.vehicles();
  throw ConfigError(
      fmt::format("no vehicle '{}'{} (known: {})", name, did_you_mean(name, known), join(known)));
}

Typed<"vinerow.world.Map"> map_of(PythonSession& session, const TextArgument& vehicle) {
  PythonSession::Use use(session);
  return map_to_python(find_vehicle(*use, vehicle.value("vehicle")).map());
}

Typed<"vinerow.world.Vehicle"> vehicle_of(PythonSession& session, const TextArgument& vehicle) {
  PythonSession::Use use(session);
  const std::string name = vehicle.value("vehicle");
  return vehicle_to_python(name, find_vehicle(*use, name).vehicle().description());
}

Typed<"dict[str, tuple[str, str]]"> signals(PythonSession& session) {
  py::dict all;
  for (const SignalInfo& info : PythonSession::Use(session)->signals()) {
    all[py::str(info.name)] = py::make_tuple(info.type, info.writer);
  }
  return all;
}

py::object messages(const char* type) {
  return py::module_::import("vinerow.messages").attr(type);
}

std::string_view level_name(Event::Level level) {
  for (const EnumName& name : enum_names(level)) {
    if (name.value == static_cast<std::int64_t>(level)) return name.name;
  }
  return "";
}

Typed<"list[vinerow.messages.Event]"> take_events(PythonSession& session) {
  const py::object type = messages("Event");
  py::list events;
  for (const auto& [time, event] : PythonSession::Use(session)->take_events()) {
    events.append(type(time.nearest_s(), level_name(event.level), event.source, event.text));
  }
  return events;
}

Typed<"list[vinerow.messages.Crash]"> crashes(PythonSession& session) {
  const py::object type = messages("Crash");
  py::list list;
  for (const SessionCrash& crash : PythonSession::Use(session)->crashes()) {
    list.append(type(crash.vehicle, crash.time.nearest_s(), crash.text));
  }
  return list;
}

std::optional<double> seconds_if(const std::optional<Time>& time) {
  return time ? std::optional(time->nearest_s()) : std::nullopt;
}

Typed<"list[vinerow.messages.Phase]"> phases(PythonSession& session) {
  const py::object type = messages("Phase");
  py::list list;
  for (const SessionPhase& phase : PythonSession::Use(session)->phases()) {
    list.append(type(phase.name, phase.state, seconds_if(phase.begin), seconds_if(phase.end),
                     phase.reason, phase.numbers));
  }
  return list;
}

/// A method of Session that only reads, with the checks around it.
template <class T>
auto reading(T (Session::*method)() const) {
  return [method](PythonSession& session) { return ((*PythonSession::Use(session)).*method)(); };
}

}  // namespace

PythonSession::Use::Use(PythonSession& owner) : owner_(owner), hold_(owner.guard_) {
  if (!owner_.session_) throw UsageError("the session is closed");
}

void PythonSession::step(Time until) {
  Use use(*this);
  step(use, until);
}

void PythonSession::step_for(Duration duration) {
  Use use(*this);
  if (duration < use->step()) {
    throw UsageError(
        fmt::format("duration_s = {} is shorter than the physics step of {} s, in which nothing "
                    "happens",
                    duration.s(), use->step().s()));
  }
  step(use, use->now() + duration - use->step());
}

void PythonSession::step(Use& use, Time until) {
  while (true) {
    without_lock([&] { use->advance(std::min(until, use->now() + kInterruptPeriod)); });
    if (use->now() > until || use->over()) return;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
}

void PythonSession::reset(std::optional<std::uint64_t> seed) {
  Use use(*this);
  without_lock([&] { use->reset(seed ? *seed : use->seed()); });
  ++run_number_;
}

std::shared_ptr<PythonSession> PythonSession::twin() {
  Use use(*this);
  return without_lock([&] { return std::make_shared<PythonSession>(use->twin()); });
}

void PythonSession::close() {
  // In a forked child there is nothing to close: the session is its parent's.
  if (closed() || !guard_.in_own_process()) return;
  Use use(*this);
  {
    const py::gil_scoped_release release;
    session_.reset();
  }
  ++run_number_;
}

void bind_session(py::module_& module) {
  py::class_<PythonSession, std::shared_ptr<PythonSession>>(
      module, "Session", R"(A run that the calling program steps. vinerow.open() makes it.

Times are simulated seconds, rounded to nanoseconds. How a run is divided into calls changes no bit of its
result. One thread at a time may use a session. Methods raise UsageError after close(), in another thread's
step, or in a forked child.)")
      .def(py::init(&open), py::arg("scenario"), py::arg("take_over"))
      .def(
          "step",
          [](PythonSession& session, const NumberArgument& until_s) {
            session.step(time_of(until_s, "until_s"));
          },
          py::arg("until_s"),
          R"(Processes every instant up to and including until_s, or to the end of the run.

Raises SimulationError if the run breaks off, ConfigError if it is over or a plan cannot be made.)")
      .def(
          "step_for",
          [](PythonSession& session, const NumberArgument& duration_s) {
            session.step_for(duration_of(duration_s, "duration_s"));
          },
          py::arg("duration_s"),
          "Processes the instants of the next duration_s, at least one physics step. Raises what "
          "step() raises.")
      .def(
          "reset",
          [](PythonSession& session, const std::optional<SeedArgument>& seed) {
            session.reset(seed ? std::optional(seed->value()) : std::nullopt);
          },
          py::arg("seed") = py::none(),
          "Restarts at time 0, with the same seed if none is given. Signals remain valid; views "
          "keep the old run's values.")
      .def("twin", &PythonSession::twin,
           "Another session of the same scenario, at time 0, for another thread; shares the world.")
      .def("_repr_html_", html_by("session_html"))
      .def("close", &PythonSession::close, "Frees the run, except for memory that views refer to.")
      .def_property_readonly("closed", &PythonSession::closed)
      .def("__enter__", [](std::shared_ptr<PythonSession> session) { return session; })
      .def("__exit__", [](PythonSession& session, const py::args&) { session.close(); })
      .def_property_readonly(
          "now_s",
          [](PythonSession& session) { return PythonSession::Use(session)->now().nearest_s(); },
          "The next instant to be processed; 0 at the start.")
      .def_property_readonly("over", reading(&Session::over), "The run has ended.")
      .def_property_readonly(
          "finished", reading(&Session::finished),
          "Every controller has finished and no vehicle crashed; in a mission, every phase "
          "succeeded.")
      .def_property_readonly("seed", reading(&Session::seed))
      .def_property_readonly("digest", reading(&Session::digest),
                             "Digest of every signal so far; that of `vinerow run` at the end.")
      .def_property_readonly("vehicles", reading(&Session::vehicles),
                             "Names, in the scenario's order.")
      .def("metrics", reading(&Session::metrics),
           "Present values: {vehicle: {metric: number}}, and {phase: {number}} for jobs.")
      .def("signals", &signals, "{name: (type, writer)} of all signals.")
      .def(
          "signal",
          [](std::shared_ptr<PythonSession> session, const TextArgument& name) {
            return PythonSignal(std::move(session), name.value("name"));
          },
          py::arg("name"), "A signal by name, \"rover/truth\". Raises ConfigError without one.")
      .def(
          "command", &command, py::arg("signal"), py::arg("value"), py::arg("at_s") = py::none(),
          R"(Sets a signal that was taken over, at the first instant at or after at_s (default: now).

value: {name: number} for actuators, else {field: value}; fields that are absent keep their default.
Raises ConfigError on an unknown signal, field or actuator, a wrong type or shape, NaN, or a time in the past.)")
      .def(
          "world", [](PythonSession & session) -> Typed<"vinerow.world.World"> {
            return world_to_python(PythonSession::Use(session)->simulation().world());
          },
          "A vinerow.World: copies of terrain, rows and alleys.")
      .def("map", &map_of, py::arg("vehicle"), "A vinerow.Map: the world as the vehicle knows it.")
      .def("vehicle", &vehicle_of, py::arg("vehicle"), "A vinerow.Vehicle: its description.")
      .def("take_events", &take_events, "List of vinerow.Event since the last call.")
      .def("crashes", &crashes, "List of vinerow.Crash.")
      .def("phases", &phases, "List of vinerow.Phase; empty without a mission.");
}

}  // namespace vinerow::python
