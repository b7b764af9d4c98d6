#include "engine/sim/session.h"

#include <fmt/format.h>

#include <utility>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/scenario/scenario_seed.h"
#include "engine/sim/crash.h"
#include "engine/sim/run_shelf.h"
#include "engine/sim/simulation.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow {
namespace {

/// Sentence on the end of a run.
std::string end_text(const Simulation& simulation) {
  if (simulation.finished()) return "mission finished";
  if (!simulation.scenario().phases.empty()) return "mission ended";
  if (simulation.crashes().empty()) return "duration is over";
  const EndKind kind = simulation.crashes().front().kind;
  return kind == EndKind::kCrashed ? "ended after a crash"
                                   : fmt::format("ended: a vehicle {}", to_string(kind));
}

}  // namespace

struct Session::Impl {
  class EventCollector final : public RunObserver {
   public:
    void on_event(Time now, const Event& event) override { events.push_back({now, event}); }
    std::vector<SessionEvent> events;
  };
  /// A run, its observer, and what both need.
  struct Run {
    Run(const scenario::Scenario& scenario, const Impl& owner, SimulationSetup setup)
        : registry(owner.registry),
          shelf(owner.shelf),
          simulation(scenario, *registry, std::move(setup)) {
      simulation.add_observer(&events);
    }
    std::shared_ptr<const Registry> registry;
    std::shared_ptr<RunShelf> shelf;
    EventCollector events;
    Simulation simulation;
    bool announced = false;  ///< the event of the start was reported
  };

  std::shared_ptr<const Registry> registry;
  SessionOptions options;
  std::shared_ptr<RunShelf> shelf;
  std::shared_ptr<Run> run;  ///< shared with run_memory()
  std::map<std::string, std::shared_ptr<SignalSlot>> slots;
  std::string broken;  ///< reason why the run broke off; empty if it did not

  ~Impl() {
    for (const auto& [name, slot] : slots) slot->signal = nullptr;
  }

  void begin(const scenario::Scenario& scenario, std::optional<BuiltWorld> world) {
    SimulationSetup setup;
    setup.products = options.products;
    setup.world = std::move(world);
    setup.outside = options.outside;
    setup.shelf = &shelf->files();
    setup.is_rehearsal = options.is_rehearsal;
    // The old run stays until the new one exists, so that an exception here changes nothing.
    run = std::make_shared<Run>(scenario, *this, std::move(setup));
    broken.clear();
    for (const auto& [name, slot] : slots) slot->signal = run->simulation.bus().find(name);
  }

  /// Steps and reports start, end and failure as events, which are part of the digest.
  void advance(Time until) {
    Simulation& simulation = run->simulation;
    if (!std::exchange(run->announced, true)) {
      simulation.emit(Event::Level::kInfo, "run",
                      fmt::format("started '{}'", simulation.scenario().name));
    }
    try {
      simulation.run_until(until);
    } catch (const SimulationError& error) {
      simulation.emit(Event::Level::kError, error.culprit(), error.what());
      throw;
    }
    if (simulation.over()) simulation.emit(Event::Level::kInfo, "run", end_text(simulation));
  }

  const SignalBase& find(const std::string& name) const {
    const SignalBus& bus = run->simulation.bus();
    if (const SignalBase* signal = bus.find(name)) return *signal;
    std::vector<std::string> known;
    for (const auto& signal : bus.signals()) known.push_back(signal->name());
    throw ConfigError(
        fmt::format("no signal '{}'{} (known: {})", name, did_you_mean(name, known), join(known)));
  }

  void demand_going(const char* what) const {
    const Simulation& simulation = run->simulation;
    if (!broken.empty()) {
      throw ConfigError(fmt::format("{}: session '{}' broke off: {}; call reset() to restart", what,
                                    simulation.scenario().name, broken));
    }
    if (simulation.over()) {
      throw ConfigError(fmt::format("{}: session '{}' is over at {:.9g} s; call reset() to restart",
                                    what, simulation.scenario().name, simulation.now().s()));
    }
  }
};

Session::Session(const scenario::Scenario& scenario, std::shared_ptr<const Registry> registry,
                 SessionOptions options)
    : impl_(std::make_unique<Impl>()) {
  impl_->registry = std::move(registry);
  impl_->options = std::move(options);
  const bool shares = impl_->options.shelf != nullptr;
  impl_->shelf = shares ? impl_->options.shelf : std::make_shared<RunShelf>();
  std::optional<BuiltWorld> world;
  if (shares) world = impl_->shelf->world(scenario, *impl_->registry);
  impl_->begin(scenario, std::move(world));
}

Session::Session(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

Session Session::twin() const {
  auto twin = std::make_unique<Impl>();
  twin->registry = impl_->registry;
  twin->options = impl_->options;
  twin->options.products.clear();
  twin->shelf = impl_->shelf;
  twin->begin(scenario(), simulation().built_world());
  return Session(std::move(twin));
}

void Session::reset(std::uint64_t seed) {
  const scenario::Scenario next = scenario::with_seed(scenario(), seed);
  impl_->begin(next, reseed_world(simulation().built_world(), next, *impl_->registry,
                                  &impl_->shelf->files()));
}

void Session::reset() {
  reset(seed());
}

void Session::advance(Time until) {
  impl_->demand_going("advance");
  try {
    impl_->advance(until);
  } catch (const std::exception& error) {
    impl_->broken = error.what();
    throw;
  }
}

void Session::advance_for(Duration duration) {
  advance(now() + duration - step());
}

Time Session::now() const {
  return simulation().now();
}

Duration Session::step() const {
  return scenario().physics_step;
}

std::uint64_t Session::steps() const {
  return simulation().steps();
}

bool Session::over() const {
  return simulation().over();
}

bool Session::finished() const {
  return simulation().finished();
}

void Session::command(OutsideCommand command) {
  impl_->demand_going("command");
  impl_->run->simulation.command(std::move(command));
}

std::shared_ptr<const SignalSlot> Session::slot(const std::string& name, const char* type) {
  const SignalBase& signal = impl_->find(name);
  if (std::string_view(signal.type()) != type) {
    throw ConfigError(fmt::format("signal '{}' is {}, not {}", name, signal.type(), type));
  }
  std::shared_ptr<SignalSlot>& slot = impl_->slots[name];
  if (!slot) slot = std::make_shared<SignalSlot>(SignalSlot{name, &signal});
  return slot;
}

const SignalBase& Session::any_signal(const std::string& name) const {
  return impl_->find(name);
}

std::vector<SignalInfo> Session::signals() const {
  std::vector<SignalInfo> all;
  for (const auto& signal : simulation().bus().signals()) {
    all.push_back({signal->name(), signal->type(), signal->writer()});
  }
  return all;
}

std::vector<std::string> Session::vehicles() const {
  std::vector<std::string> names;
  for (const auto& vehicle : simulation().vehicles()) names.push_back(vehicle->name());
  return names;
}

std::map<std::string, std::map<std::string, double>> Session::metrics() const {
  return simulation().metrics();
}

std::vector<SessionCrash> Session::crashes() const {
  std::vector<SessionCrash> all;
  for (const Crash& crash : simulation().crashes()) {
    all.push_back({crash.vehicle, crash.time, crash.text});
  }
  return all;
}

std::vector<SessionPhase> Session::phases() const {
  std::vector<SessionPhase> all;
  for (const PhaseReport& phase : simulation().phases()) {
    all.push_back(
        {phase.name, to_string(phase.state), phase.begin, phase.end, phase.reason, phase.numbers});
  }
  return all;
}

std::vector<SessionEvent> Session::take_events() {
  return std::exchange(impl_->run->events.events, {});
}

std::string Session::digest() const {
  return simulation().digest();
}

std::uint64_t Session::seed() const {
  return scenario().seed;
}

std::shared_ptr<const void> Session::run_memory() const {
  return impl_->run;
}

const scenario::Scenario& Session::scenario() const {
  return simulation().scenario();
}

Simulation& Session::simulation() {
  return impl_->run->simulation;
}

const Simulation& Session::simulation() const {
  return impl_->run->simulation;
}

}  // namespace vinerow
