#include "engine/sim/simulation.h"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <atomic>

#include "engine/api/map.h"
#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/core/profile.h"
#include "engine/core/suggest.h"
#include "engine/io/files/plain_zeros.h"
#include "engine/sim/camera_check.h"
#include "engine/sim/mission.h"
#include "engine/sim/separation.h"
#include "engine/sim/traffic_control.h"
#include "engine/sim/vehicle_rays.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow {
namespace {

/// Path of a folder that no other simulation on this machine uses.
std::filesystem::path make_own_folder() {
  static std::atomic<int> count = 0;
  return std::filesystem::temp_directory_path() /
         fmt::format("vinerow_products_{}_{}", ::getpid(), ++count);
}

/// Warning if the default air density belongs to another altitude than that of the ground, else "".
std::string density_warning(const WorldModel& world) {
  constexpr double kSameAir_m = 150.0;  // 1.4 % of the density
  const Wind& wind = world.wind;
  if (!world.terrain || wind.atmosphere != Atmosphere::kConstant || wind.air_density_kgm3)
    return "";
  const HeightField& ground = *world.terrain;
  const Eigen::Vector2d middle =
      ground.corner_W + 0.5 * Eigen::Vector2d(ground.width_m(), ground.depth_m());
  const double height_m = ground.height_m(middle.x(), middle.y());
  if (std::abs(height_m) <= kSameAir_m) return "";
  return fmt::format(
      "the air has the density at the origin's altitude, {:.0f} m, but the ground is at z = "
      "{:.0f} "
      "m: set wind.atmosphere to us76, or air_density_kgm3, or origin_altitude_m",
      world.origin.altitude_m, height_m);
}

}  // namespace

Simulation::Simulation(const scenario::Scenario& scenario, const Registry& registry,
                       SimulationSetup setup)
    : scenario_(scenario),
      world_(setup.world ? *std::move(setup.world)
                         : build_static_world(scenario, registry, setup.shelf)),
      outside_(bus_, setup.outside),
      scheduler_(scenario.physics_step) {
  VINEROW_DEMAND(world_.seed == scenario.seed);
  physics::PhysicsSettings settings;
  settings.step = scenario_.physics_step;
  settings.gravity_mps2 = scenario_.gravity_mps2;
  const ProfileSpan span("run", "set-up");
  physics_ = std::make_unique<physics::PhysicsWorld>(settings, world_.scene, *world_.model);

  refuse_hidden_cameras(scenario_.pictures, world(), physics_->scene());

  events_ = bus_.advertise<Event>("run/events", "run");
  if (!world().rows->occupancy.empty()) map_ = bus_.advertise<OccupancyGrid>("run/map", "run");
  const bool has_autopilot = std::any_of(
      scenario_.vehicles.begin(), scenario_.vehicles.end(),
      [](const scenario::VehicleConfig& vehicle) { return vehicle.autopilot.has_value(); });
  if (setup.products.empty() && (has_autopilot || !scenario_.phases.empty())) {
    setup.products = own_products_ = make_own_folder();
  }
  const RunContext run{scenario_,
                       registry,
                       world(),
                       *physics_,
                       bus_,
                       scheduler_,
                       setup.shelf,
                       setup.products,
                       setup.is_rehearsal,
                       [this]() -> VehicleScene& {
                         if (!vehicle_rays_) {
                           vehicle_rays_ = std::make_unique<VehicleRays>(vehicles_);
                         }
                         return *vehicle_rays_;
                       },
                       [this](Event::Level level, const std::string& source,
                              const std::string& text) { emit(level, source, text); }};
  std::vector<StartBox> starts;
  for (const scenario::VehicleConfig& vehicle : scenario_.vehicles) {
    const ProfileSpan vehicle_span(vehicle.name, "set-up");
    vehicles_.push_back(std::make_unique<VehicleRuntime>(vehicle, run, starts));
    // In a mission, a vehicle starts with its phase.
    if (scenario_.phases.empty()) {
      vehicles_.back()->begin(now_, {});
    } else {
      vehicles_.back()->park();
    }
  }
  if (!scenario_.phases.empty()) {
    mission_ = std::make_unique<Mission>(run, vehicles_, std::move(setup.products));
  }
  add_traffic(run);
  bus_.check_connected();
  outside_.close();
  check_lockstep();
  classify_signals();
}

void Simulation::check_lockstep() const {
  const std::string& signal = scenario_.lockstep.signal;
  const std::vector<std::string>& known = outside_.signals();
  if (signal.empty() || std::find(known.begin(), known.end(), signal) != known.end()) return;
  throw ConfigError(fmt::format(
      "{}: lockstep.topic = '{}': {}", scenario_.lockstep.where.text(), signal,
      known.empty() ? "no part of this scenario takes commands from outside (controllers: "
                      "remote_velocity, remote_actuators)"
                    : fmt::format("no part takes commands from outside as that{} (there are: {})",
                                  did_you_mean(signal, known), join(known))));
}

void Simulation::add_traffic(const RunContext& run) {
  const Duration period = period_of_rate(TrafficControl::kRate_Hz);
  // If the physics step does not divide this period, the separation is not measured.
  if (vehicles_.size() > 1 && period.ns % scenario_.physics_step.ns == 0) {
    separation_ = std::make_unique<Separation>(static_cast<int>(vehicles_.size()));
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      vehicles_[i]->measure_separation(*separation_, static_cast<int>(i));
    }
    scheduler_.add(Stage::kJudge, "run.separation", period, {},
                   [this](Time now) { watch_separation(now); });
  }
  if (scenario_.traffic.vehicles.empty()) return;
  traffic_ = std::make_unique<TrafficControl>(
      run, vehicles_, [this](VehicleRuntime& vehicle, const std::string& reason) {
        if (!mission_) return vehicle.give_up(now_, reason);
        emit(Event::Level::kError, "traffic", reason);
        // This runs inside a task, and phases may end only when no task runs.
        lost_vehicles_.emplace_back(vehicle.name(), reason);
      });
  scheduler_.add(Stage::kPlan, "run.traffic", period, {},
                 [this](Time now) { traffic_->step(now); });
}

void Simulation::watch_separation(Time now) {
  for (int i = 0; i < separation_->vehicles(); ++i) {
    const VehicleDescription& description = vehicles_[i]->vehicle().description();
    separation_->place(i, vehicles_[i]->truth().X_WB, description.collision_centre_B,
                       description.collision_half_extents_m);
  }
  separation_->update(now);
}

Simulation::~Simulation() {
  std::error_code ignored;
  if (!own_products_.empty()) std::filesystem::remove_all(own_products_, ignored);
}

void Simulation::classify_signals() {
  hashed_sequence_.assign(bus_.signals().size(), 0);
  hashed_.assign(bus_.signals().size(), true);
  // Events only repeat in words what other signals contain.
  for (std::size_t i = 0; i < bus_.signals().size(); ++i) {
    const auto* event = dynamic_cast<const Signal<Event>*>(bus_.signals()[i].get());
    if (event == nullptr) continue;
    hashed_[i] = false;
    if (event->name() != "run/events") part_events_.push_back({event, 0});
  }
  for (const auto& vehicle : vehicles_) {
    for (const std::string& diagnostic : vehicle->diagnostic_signals()) {
      for (std::size_t i = 0; i < bus_.signals().size(); ++i) {
        if (bus_.signals()[i]->name() == diagnostic) hashed_[i] = false;
      }
    }
  }
}

void Simulation::emit(Event::Level level, const std::string& source, const std::string& text) {
  const Event event{level, source, io::plain_zeros(text)};
  events_.write(now_, event);
  for (RunObserver* observer : observers_) observer->on_event(now_, event);
}

void Simulation::command(OutsideCommand command) {
  for (const auto& vehicle : vehicles_) vehicle->check_command(*command.value);
  outside_.add(std::move(command), now_);
}

std::vector<PhaseReport> Simulation::phases() const {
  return mission_ ? mission_->reports() : std::vector<PhaseReport>{};
}

bool Simulation::finished() const {
  if (mission_) return mission_->succeeded();
  bool any = false;
  for (const auto& vehicle : vehicles_) {
    if (vehicle->crash()) return false;
    if (!vehicle->has_controller()) continue;
    any = true;
    if (!vehicle->finished()) return false;
  }
  return any;
}

std::vector<Crash> Simulation::crashes() const {
  std::vector<Crash> all;
  for (const auto& vehicle : vehicles_) {
    if (vehicle->crash()) all.push_back(*vehicle->crash());
  }
  return all;
}

bool Simulation::is_done() const {
  if (mission_) return mission_->over();
  bool any = false, all = true;
  for (const auto& vehicle : vehicles_) {
    if (vehicle->crash() && vehicle->on_crash() == scenario::OnCrash::kEnd) return true;
    if (!vehicle->has_controller()) continue;
    any = true;
    all = all && (vehicle->crash() || vehicle->finished());
  }
  return scenario_.stop_when_finished && any && all;
}

void Simulation::work_instant() {
  if (now_.ns == 0 && map_.connected()) map_.write(now_, world().rows->occupancy);
  if (now_.ns == 0) {
    const std::string doubt = density_warning(world());
    if (!doubt.empty()) emit(Event::Level::kWarning, "world", doubt);
  }
  {
    const ProfileSpan span("truth and commands from outside", "sense");
    for (const auto& vehicle : vehicles_) vehicle->publish_truth(now_);
    outside_.deliver(now_);
  }
  if (mission_) {
    for (const auto& [vehicle, reason] : lost_vehicles_) {
      mission_->fail_phase_of(vehicle, now_, reason);
    }
    lost_vehicles_.clear();
    mission_->advance(now_);
  }
  scheduler_.run_due(now_);
  pass_on_events();
  {
    const ProfileSpan span("digest", "record");
    hash_new_signals();
  }
  const ProfileSpan span("log and other observers", "record");
  for (RunObserver* observer : observers_) observer->on_instant(now_);
}

void Simulation::pass_on_events() {
  for (auto& [signal, seen] : part_events_) {
    if (signal->sequence() == seen) continue;
    seen = signal->sequence();
    const Event& event = signal->value();
    emit(event.level, event.source.empty() ? signal->writer() : event.source, event.text);
  }
}

void Simulation::hash_new_signals() {
  const auto& signals = bus_.signals();
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (signals[i]->sequence() == hashed_sequence_[i]) continue;
    hashed_sequence_[i] = signals[i]->sequence();
    if (hashed_[i]) signals[i]->hash_into(hasher_);
  }
}

void Simulation::step_physics() {
  const Duration step = scenario_.physics_step;
  for (const auto& vehicle : vehicles_) vehicle->before_physics(now_, step);
  {
    const ProfileSpan span("rigid bodies", "physics");
    physics_->step(step);
  }
  now_ = now_ + step;
  ++steps_;
  for (const auto& vehicle : vehicles_) vehicle->after_physics(now_, step);
}

void Simulation::run_until(Time end) {
  const Time last{duration_from_s(scenario_.duration_s).ns / scenario_.physics_step.ns *
                  scenario_.physics_step.ns};
  while (!over_ && now_ <= end) {
    work_instant();
    over_ = now_ >= last || is_done();
    if (over_) end_mission();
    if (!over_) step_physics();
  }
}

void Simulation::end_mission() {
  if (!mission_ || mission_->over()) return;
  mission_->close(now_,
                  fmt::format("the run ended after its duration of {:g} s", scenario_.duration_s));
}

void Simulation::run() {
  run_until(Time{duration_from_s(scenario_.duration_s).ns});
}

std::map<std::string, std::map<std::string, double>> Simulation::metrics() const {
  std::map<std::string, std::map<std::string, double>> all;
  for (const auto& vehicle : vehicles_) all[vehicle->name()] = vehicle->metric_results();
  if (!mission_) return all;
  for (const PhaseReport& phase : mission_->reports()) {
    if (!phase.job.empty()) all[phase.name] = phase.numbers;
  }
  return all;
}

std::map<std::string, std::map<std::string, double>> Simulation::planning() const {
  std::map<std::string, std::map<std::string, double>> all;
  for (const auto& vehicle : vehicles_) {
    if (!vehicle->plan_numbers().empty()) all[vehicle->name()] = vehicle->plan_numbers();
  }
  return all;
}

const Odometry& Simulation::truth(const std::string& name) const {
  std::vector<std::string> known;
  for (const auto& vehicle : vehicles_) {
    if (vehicle->name() == name) return vehicle->truth();
    known.push_back(vehicle->name());
  }
  throw ConfigError(fmt::format("no vehicle '{}' in this run{} (known: {})", name,
                                did_you_mean(name, known), join(known)));
}

}  // namespace vinerow
