#include "engine/sim/vehicle_runtime.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/map.h"
#include "engine/api/may_fail.h"
#include "engine/core/error.h"
#include "engine/core/profile.h"
#include "engine/sensors/blindness.h"
#include "engine/sim/map_edges.h"

namespace vinerow {
namespace {

/// Smallest multiple of the physics step that is not shorter than 1 / rate.
Duration diagnostics_period(double rate_Hz, Duration step) {
  const double wanted_ns = 1e9 / rate_Hz;
  return {static_cast<std::int64_t>(std::ceil(wanted_ns / static_cast<double>(step.ns) - 1e-9)) *
          step.ns};
}

}  // namespace

VehicleRuntime::VehicleRuntime(const scenario::VehicleConfig& config, const RunContext& run,
                               std::vector<StartBox>& others)
    : config_(config),
      run_(run),
      first_body_(run_.physics.body_count()),
      vehicle_(make_placed_vehicle(config_, run_)),
      end_body_(run_.physics.body_count()),
      watch_(config_, run_, *vehicle_, first_body_, end_body_) {
  const std::string& name = config_.name;
  vehicle_->read_truth(truth_);
  const StartBox box = find_start_box(name, truth_.X_WB, vehicle_->description());
  refuse_start_in_contact(config_.spawn, box, others, run_.world, run_.physics.scene());
  others.push_back(box);

  Ports ports(run_.bus, name, name);
  truth_writer_ = ports.write<Odometry>("truth");
  const std::size_t own_signals_begin = run_.bus.signals().size();
  links_writer_ = ports.write<LinkPoses>("links");
  vehicle_->connect(ports);
  for (std::size_t i = own_signals_begin; i < run_.bus.signals().size(); ++i) {
    diagnostic_signals_.push_back(run_.bus.signals()[i]->name());
  }
  for (const VehicleLink& link : vehicle_->links()) links_.names.push_back(link.name);
  links_.X_WL.resize(links_.names.size());
  watch_.connect(ports);

  run_.scheduler.add(
      Stage::kSense, name + ".diagnostics",
      diagnostics_period(run_.scenario.record.truth_rate_Hz, run_.scenario.physics_step), {},
      [this](Time now) { publish_diagnostics(now); });
}

void VehicleRuntime::park() {
  for (int i = first_body_; i < end_body_; ++i) {
    // Bodies that the vehicle itself holds, such as an aircraft on its launcher, stay as they are.
    if (run_.physics.is_kinematic({i})) continue;
    run_.physics.set_held({i}, true);
    held_bodies_.push_back(i);
  }
  parked_ = true;
  vehicle_->read_truth(truth_);
  truth_.v_WB_B = truth_.w_WB_B = Eigen::Vector3d::Zero();
}

void VehicleRuntime::unpark() {
  for (const int i : held_bodies_) run_.physics.set_held({i}, false);
  held_bodies_.clear();
  parked_ = false;
}

void VehicleRuntime::rehearse(const PhaseHandover& handover) {
  assemble(handover, std::nullopt);
  for (std::size_t i = 0; i < parts_->sensors.size(); ++i) {
    auto* const looking = dynamic_cast<sensors::LooksOut*>(parts_->sensors[i].get());
    if (looking == nullptr) continue;
    const scenario::NamedPart& sensor = config_.sensors[i];
    guarded(run_.bus, fmt::format("{}.sensors.{}", name(), sensor.name), sensor.part,
            [&](Time) { looking->check_view(truth_.X_WB); })(Time{0});
  }
}

void VehicleRuntime::begin(Time now, const PhaseHandover& handover) {
  worked_ = true;
  stranded_ = false;
  if (parked_) {
    unpark();
    publish_truth(now);  // not yet written at this instant, because the vehicle was parked
  }
  watch_.begin(now);
  assemble(handover, now);
}

void VehicleRuntime::assemble(const PhaseHandover& handover, std::optional<Time> begin) {
  stop();
  parts_ = std::make_unique<VehicleParts>();
  run_.bus.release(config_.name);
  given_plan_ = handover.plan;
  planned_ = has_reported_finished_ = false;
  plan_failure_.clear();
  actuators_seen_ = 0;
  actuator_names_.clear();
  actuator_values_.assign(vehicle_->description().actuators.size(), 0.0);
  VehicleAssembly(config_, run_, *vehicle_, *parts_)
      .build(handover, begin,
             {[this](Time now) { try_to_plan(now); }, [this](Time now) { actuate(now); }});
  map_edges_due_ = begin && parts_->map_edges.connected();
  for (const std::string& signal : parts_->diagnostics) {
    const auto known = std::find(diagnostic_signals_.begin(), diagnostic_signals_.end(), signal);
    if (known == diagnostic_signals_.end()) diagnostic_signals_.push_back(signal);
  }
}

void VehicleRuntime::stop() {
  for (const int task : parts_->tasks) run_.scheduler.remove(task);
  parts_->tasks.clear();
}

void VehicleRuntime::end(bool done) {
  stranded_ = !done;
  if (!done && vehicle_->description().flies()) return;
  stop();
  actuate_zero();
  park();
}

bool VehicleRuntime::finished() const {
  if (crash()) return false;
  if (!parts_->controller) return true;
  // A part may fail at the same instant at which the controller finishes.
  const bool has_failed = std::any_of(parts_->may_fail.begin(), parts_->may_fail.end(),
                                      [](const MayFail* part) { return !part->failure().empty(); });
  return at_work() && parts_->controller->finished() && !has_failed;
}

void VehicleRuntime::publish_truth(Time now) {
  if (parked_) return;
  vehicle_->read_truth(truth_);
  truth_writer_.write(now, truth_);
}

void VehicleRuntime::publish_diagnostics(Time now) {
  // A parked vehicle does not move, but the log needs its pose all the same.
  if (parked_) truth_writer_.write(now, truth_);
  vehicle_->read_links(links_.X_WL);
  links_writer_.write(now, links_);
  vehicle_->publish(now);
  if (now.ns == 0) watch_.publish_contacts(now);
  // The log contains the map itself, so that viewers need not rebuild it from the world.
  if (map_edges_due_) {
    map_edges_due_ = false;
    parts_->map_edges.write(now, map_edges(*parts_->own_map));
  }
}

void VehicleRuntime::before_physics(Time now, Duration step) {
  if (parked_) return;
  const ProfileSpan span(config_.name, "physics");
  vehicle_->before_physics(now, step);
}

void VehicleRuntime::after_physics(Time now, Duration step) {
  if (parked_) return;
  const ProfileSpan span(config_.name, "physics");
  vehicle_->after_physics(now, step);
  watch_.check(now, *parts_);
}

Result<PlannedPath> VehicleRuntime::plan_ahead(std::shared_ptr<const RowMap> map) const {
  if (!config_.planner) {
    return Failure{fmt::format("vehicle '{}' has no planner", config_.name)};
  }
  // The map is used for this plan only and does not replace the vehicle's own map.
  VehicleParts parts;
  try {
    return VehicleAssembly(config_, run_, *vehicle_, parts)
        .build_planner(std::move(map))
        ->plan(truth_.X_WB);
  } catch (const ConfigError& error) {
    return Failure{error.what()};
  }
}

void VehicleRuntime::try_to_plan(Time now) {
  if (planned_ || !plan_failure_.empty() || !parts_->estimate.has_value()) return;
  Result<PlannedPath> plan = Failure{};
  if (given_plan_) {
    plan = *given_plan_;
  } else {
    guarded(run_.bus, config_.name + ".planner", *config_.planner,
            [&](Time) { plan = parts_->planner->plan(parts_->estimate.value().X_WB); })(now);
  }
  if (!plan) {
    const std::string reason =
        fmt::format("{}.planner ({}): {}", config_.name, config_.planner->type, plan.reason());
    // A failed plan is bad input, not an error of the simulation.
    if (run_.scenario.phases.empty()) {
      throw ConfigError(fmt::format("{}: {}", config_.planner->place_of(reason).text(), reason));
    }
    plan_failure_ = reason;
    return;
  }
  planned_ = true;
  parts_->plan.write(now, *plan);
  std::string event_text =
      fmt::format("planned {:.2f} m with {} points", plan->length_m, plan->points.size());
  if (const PlanReport* report = parts_->planner ? parts_->planner->report() : nullptr) {
    plan_numbers_ = report->numbers;
    if (!report->tree.points_W.empty()) parts_->tree.write(now, report->tree);
    // Some planners report dozens of numbers, too many for a sentence.
    if (!report->numbers.empty()) {
      event_text += fmt::format("; its numbers are in summary.json, planning.{}", config_.name);
    }
  }
  run_.emit(Event::Level::kInfo, config_.name + ".planner", event_text);
}

void VehicleRuntime::check_command(const SignalBase& value) const {
  const bool is_meant = value.name() == config_.name + "/actuators" ||
                        value.name() == config_.name + "/actuator_command";
  if (!is_meant) return;
  if (std::string_view(value.type()) != NamedValues::kType) return;
  const NamedValues& wanted = static_cast<const Signal<NamedValues>&>(value).value();
  if (wanted.names.size() != wanted.values.size()) {
    throw ConfigError(fmt::format("a command for '{}' has {} values for {} names", value.name(),
                                  wanted.values.size(), wanted.names.size()));
  }
  const VehicleDescription& description = vehicle_->description();
  for (const std::string& name : wanted.names) {
    const bool exists =
        std::any_of(description.actuators.begin(), description.actuators.end(),
                    [&](const ActuatorSpec& actuator) { return actuator.name == name; });
    if (exists) continue;
    // For its sentence, which is not formatted at every command.
    static_cast<void>(
        description.actuator_index(name, fmt::format("a command for '{}'", value.name())));
  }
}

std::string VehicleRuntime::driver() const {
  return config_.name + (config_.autopilot ? ".autopilot" : ".controller");
}

void VehicleRuntime::actuate(Time now) {
  if (parts_->controller && !crash() && !finished()) {
    watch_.check_progress(now, truth_.X_WB.p, actuator_values_);
  }
  if (crash() && crash()->kind == EndKind::kStuck) return actuate_zero();
  if (!has_reported_finished_ && parts_->controller && finished()) {
    has_reported_finished_ = true;
    run_.emit(Event::Level::kInfo, driver(),
              config_.autopilot ? "finished its mission" : "finished its path");
  }
  const auto& actuators = parts_->actuators;
  if (!actuators.has_value() || !actuators.is_newer_than(actuators_seen_)) return;
  take_actuators(now, actuators.value());
}

void VehicleRuntime::take_actuators(Time now, const NamedValues& wanted) {
  const VehicleDescription& description = vehicle_->description();
  if (actuator_names_ != wanted.names) {
    actuator_names_ = wanted.names;
    actuator_index_.clear();
    for (const std::string& actuator : wanted.names) {
      actuator_index_.push_back(description.actuator_index(actuator, driver()));
    }
  }
  if (wanted.values.size() != wanted.names.size()) {
    throw SimulationError(driver(), now,
                          fmt::format("wrote {} actuator values for {} names", wanted.values.size(),
                                      wanted.names.size()));
  }
  for (std::size_t i = 0; i < wanted.values.size(); ++i) {
    const ActuatorSpec& spec = description.actuators[actuator_index_[i]];
    actuator_values_[actuator_index_[i]] = std::clamp(wanted.values[i], spec.min, spec.max);
  }
  vehicle_->actuate(actuator_values_);
}

void VehicleRuntime::actuate_zero() {
  actuator_values_.clear();
  for (const ActuatorSpec& spec : vehicle_->description().actuators) {
    actuator_values_.push_back(std::clamp(0.0, spec.min, spec.max));
  }
  vehicle_->actuate(actuator_values_);
}

std::map<std::string, double> VehicleRuntime::metric_results() const {
  std::map<std::string, double> all;
  for (const auto& metric : parts_->metrics) {
    for (const auto& [name, value] : metric->results()) all[name] = value;
  }
  for (const auto& [payload, part] : parts_->payloads) {
    for (const auto& [name, value] : part->results()) all[payload + "_" + name] = value;
  }
  if (separation_)
    all["min_vehicle_distance_m"] = separation_->closest(separation_index_).distance_m;
  if (!worked_) {
    for (auto& [name, value] : all) value = std::numeric_limits<double>::quiet_NaN();
  }
  return all;
}

}  // namespace vinerow
