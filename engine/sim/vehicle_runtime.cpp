#include "engine/sim/vehicle_runtime.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/may_fail.h"
#include "engine/api/observer.h"
#include "engine/api/outside.h"
#include "engine/api/sees_ground.h"
#include "engine/core/error.h"
#include "engine/sim/map_edges.h"
#include "engine/sim/truth_estimator.h"
#include "engine/sim/vehicle_parts.h"

namespace vinerow {
namespace {

/// Parameter of metrics that judge pictures: name of the sensor that takes them.
constexpr const char* kCamera = "camera";
/// Rate of parts without a rate of their own if the vehicle has no controller. Chosen: enough for
/// pictures; the recorder reduces it further.
constexpr double kDefaultControlRate_Hz = 20.0;

/// Smallest multiple of the physics step that is not shorter than 1 / rate.
Duration diagnostics_period(double rate_Hz, Duration step) {
  const double wanted_ns = 1e9 / rate_Hz;
  return {static_cast<std::int64_t>(std::ceil(wanted_ns / static_cast<double>(step.ns) - 1e-9)) *
          step.ns};
}

}  // namespace

std::function<void(Time)> VehicleRuntime::guarded(const std::string& part, const std::string& type,
                                                  std::function<void(Time)> step) {
  const std::string culprit = fmt::format("{} ({})", part, type);
  // Call after the part has connected: only then the bus knows the signals that it writes.
  std::vector<SignalBase*> written;
  for (const auto& signal : run_.bus.signals()) {
    if (signal->writer() == part) written.push_back(signal.get());
  }
  return [culprit, written = std::move(written), step = std::move(step)](Time now) {
    try {
      step(now);
    } catch (const SimulationError&) {
      throw;
    } catch (const std::exception& error) {
      throw SimulationError(culprit, now, fmt::format("threw an exception: {}", error.what()));
    } catch (...) {
      throw SimulationError(culprit, now, "threw an exception of unknown type");
    }
    for (SignalBase* signal : written) {
      if (signal->has_nan()) {
        throw SimulationError(culprit, now,
                              fmt::format("wrote NaN into signal '{}'", signal->name()));
      }
    }
  };
}

void VehicleRuntime::add_stepped(Stage stage, const std::string& part, const std::string& type,
                                 double rate_Hz, SteppedPart& stepped,
                                 std::map<std::string, std::string> written_as) {
  Ports ports(run_.bus, config_.name, part, std::move(written_as));
  stepped.connect(ports);
  schedule(stage, part, period_of_rate(rate_Hz), {},
           guarded(part, type, [&stepped](Time now) { stepped.step(now); }));
}

void VehicleRuntime::schedule(Stage stage, const std::string& part, Duration period,
                              Duration offset, std::function<void(Time)> run) {
  if (!begin_) return;
  tasks_.push_back(run_.scheduler.add(stage, part, period, offset, std::move(run), *begin_));
}

void VehicleRuntime::add_diagnostic(const std::string& signal) {
  const auto known = std::find(diagnostic_signals_.begin(), diagnostic_signals_.end(), signal);
  if (known == diagnostic_signals_.end()) diagnostic_signals_.push_back(signal);
}

VehicleRuntime::VehicleRuntime(const scenario::VehicleConfig& config, const RunContext& run,
                               std::vector<StartBox>& others)
    : config_(config), run_(run) {
  const std::string& name = config_.name;
  vehicle_ = with_place(config_.vehicle.where, name, [&] {
    return run_.registry.make_vehicle(config_.vehicle.type, config_.vehicle.parameters,
                                      context<VehicleContext>(name, 0.0));
  });
  const VehicleDescription& description = vehicle_->description();
  const Pose X_WB = find_spawn_pose(config_.spawn, run_.world, run_.physics.scene(), name,
                                    description.height_above_ground_m,
                                    larger_ground_hint(run_.scenario.world.parameters));
  first_body_ = run_.physics.body_count();
  with_place(config_.vehicle.where, name, [&] { vehicle_->spawn(run_.physics, X_WB); });
  end_body_ = run_.physics.body_count();
  vehicle_->read_truth(truth_);
  const StartBox box = find_start_box(name, truth_.X_WB, description);
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
  contacts_writer_ = ports.write<NamedValues>("contacts");
  contacts_.names = {"touches", "touching"};
  contacts_.values = {0.0, 0.0};

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

void VehicleRuntime::begin(Time now, const PhaseHandover& handover) {
  worked_ = true;
  stranded_ = false;
  if (parked_) {
    unpark();
    publish_truth(now);  // not yet written at this instant, because the vehicle was parked
  }
  if (now.ns > 0) {
    contacts_.values = {0.0, 0.0};
    contacts_writer_.write(now, contacts_);
  }
  assemble(handover, now);
}

void VehicleRuntime::assemble(const PhaseHandover& handover, std::optional<Time> begin) {
  take_down();
  handover_ = handover;
  begin_ = begin;
  take_map(handover.map ? handover.map : make_map());
  show_map();
  add_sensors();
  add_estimator();
  add_observers();
  add_planner();
  add_controller();
  add_payloads();
  add_metrics();
}

void VehicleRuntime::take_down() {
  for (const int task : tasks_) run_.scheduler.remove(task);
  tasks_.clear();
  metrics_.clear();
  payloads_.clear();
  may_fail_.clear();
  controller_.reset();
  guidance_.reset();
  planner_.reset();
  observers_.clear();
  estimator_.reset();
  sensors_.clear();
  mountings_.clear();
  run_.bus.release(config_.name);
  actuators_seen_ = 0;
  actuator_index_.clear();
  planned_ = has_reported_finished_ = false;
  plan_failure_.clear();
}

void VehicleRuntime::end(bool done) {
  stranded_ = !done;
  if (!done && vehicle_->description().flies()) return;
  for (const int task : tasks_) run_.scheduler.remove(task);
  tasks_.clear();
  actuator_values_.assign(vehicle_->description().actuators.size(), 0.0);
  for (std::size_t i = 0; i < actuator_values_.size(); ++i) {
    const ActuatorSpec& spec = vehicle_->description().actuators[i];
    actuator_values_[i] = std::clamp(0.0, spec.min, spec.max);
  }
  vehicle_->actuate(actuator_values_);
  park();
}

double VehicleRuntime::control_rate_Hz() const {
  return config_.controller ? config_.controller->rate_Hz : kDefaultControlRate_Hz;
}

void VehicleRuntime::add_sensors() {
  for (const scenario::NamedPart& sensor : config_.sensors) {
    const std::string part = fmt::format("{}.sensors.{}", config_.name, sensor.name);
    auto sensor_context = context<SensorContext>(part, sensor.part.rate_Hz);
    sensor_context.name = sensor.name;
    sensor_context.scene = &run_.physics.scene();
    sensor_context.world = &run_.world;
    sensor_context.vehicle_truth = vehicle_.get();
    sensors_.push_back(with_place(sensor.part.where, config_.name, [&] {
      return run_.registry.make_sensor(sensor.part.type, sensor.part.parameters, sensor_context);
    }));
    Sensor& built = *sensors_.back();
    add_stepped(Stage::kSense, part, sensor.part.type, sensor.part.rate_Hz, built);
    // The error-free reading follows from the truth.
    add_diagnostic(fmt::format("{}/{}_truth", config_.name, sensor.name));
    if (const auto X_BS = built.mounting_X_BS()) {
      mountings_.push_back({sensor.name, sensor.part.type, *X_BS});
    }
    if (built.delay().ns > 0) {
      schedule(Stage::kSense, part + ".delivery", sensor_context.period, built.delay(),
               guarded(part, sensor.part.type, [&built](Time now) { built.deliver(now); }));
    }
  }
}

void VehicleRuntime::add_estimator() {
  const std::string part = config_.name + ".estimator";
  const bool given = config_.estimator.has_value();
  const std::string type = given ? config_.estimator->type : "truth";
  const double rate_Hz =
      given && config_.estimator->rate_Hz > 0.0 ? config_.estimator->rate_Hz : control_rate_Hz();
  if (given) {
    estimator_ = with_place(config_.estimator->where, config_.name, [&] {
      return run_.registry.make_estimator(type, config_.estimator->parameters,
                                          estimator_context(part, rate_Hz));
    });
  } else {
    estimator_ = std::make_unique<TruthEstimator>();
  }
  add_stepped(Stage::kEstimate, part, type, rate_Hz, *estimator_);
}

EstimatorContext VehicleRuntime::estimator_context(const std::string& part, double rate_Hz) const {
  auto result = context<EstimatorContext>(part, rate_Hz);
  result.vehicle_description = &vehicle_->description();
  result.map = &map();
  result.sensors = mountings_;
  result.origin = run_.world.origin;
  return result;
}

void VehicleRuntime::add_observers() {
  for (const scenario::NamedPart& observer : config_.observers) {
    const std::string part = fmt::format("{}.observers.{}", config_.name, observer.name);
    const double rate_Hz = observer.part.rate_Hz > 0.0 ? observer.part.rate_Hz : control_rate_Hz();
    observers_.push_back(with_place(observer.part.where, config_.name, [&] {
      return run_.registry.make_estimator(observer.part.type, observer.part.parameters,
                                          estimator_context(part, rate_Hz));
    }));
    add_stepped(Stage::kEstimate, part, observer.part.type, rate_Hz, *observers_.back(),
                observer_signals(observer.name));
  }
}

void VehicleRuntime::add_controller() {
  if (!config_.controller && config_.guidance) {
    throw ConfigError(fmt::format(
        "{}: {}.guidance ({}) needs a controller, but the vehicle has no controller: add one, or "
        "remove the guidance",
        config_.guidance->where.text(), config_.name, config_.guidance->type));
  }
  if (!config_.controller) {
    Ports ports(run_.bus, config_.name, config_.name);
    actuators_ = ports.read_optional<NamedValues>("actuators");
    // Commands from outside act at their instant, hence at the rate of the physics step.
    const bool driven = run_.bus.find(config_.name + "/actuators")->writer() == kOutside;
    if (driven) add_actuators(run_.scenario.physics_step);
    return;
  }
  const auto controller_context_of = [&](const std::string& part, double rate_Hz) {
    auto result = context<ControllerContext>(part, rate_Hz);
    result.vehicle_description = &vehicle_->description();
    result.map = &map();
    result.sensors = mountings_;
    return result;
  };
  if (config_.guidance) {
    const std::string part = config_.name + ".guidance";
    const double rate_Hz =
        config_.guidance->rate_Hz > 0.0 ? config_.guidance->rate_Hz : control_rate_Hz();
    guidance_ = with_place(config_.guidance->where, config_.name, [&] {
      return run_.registry.make_guidance(config_.guidance->type, config_.guidance->parameters,
                                         controller_context_of(part, rate_Hz));
    });
    add_stepped(Stage::kGuide, part, config_.guidance->type, rate_Hz, *guidance_);
    note_if_it_may_fail(guidance_.get());
    if (auto* looks = dynamic_cast<SeesGround*>(guidance_.get())) {
      looks->see_ground(*planner_context().scene);
    }
    // The landing point follows from other signals.
    add_diagnostic(config_.name + "/landing");
  }
  const std::string part = config_.name + ".controller";
  controller_ = with_place(config_.controller->where, config_.name, [&] {
    return run_.registry.make_controller(config_.controller->type, config_.controller->parameters,
                                         controller_context_of(part, control_rate_Hz()));
  });
  note_if_it_may_fail(controller_.get());
  add_stepped(Stage::kControl, part, config_.controller->type, control_rate_Hz(), *controller_);
  refuse_a_missing_plan();
  progress_.emplace(vehicle_->description());
  progress_seen_ = begin_.value_or(Time{});
  Ports ports(run_.bus, config_.name, config_.name);
  actuators_ = ports.read<NamedValues>("actuators");
  add_actuators(period_of_rate(control_rate_Hz()));
}

void VehicleRuntime::note_if_it_may_fail(const SteppedPart* part) {
  if (const auto* may_fail = dynamic_cast<const MayFail*>(part)) may_fail_.push_back(may_fail);
}

ParameterSet VehicleRuntime::parameters_of(const scenario::NamedPart& metric) const {
  // Only fills in a missing camera; the part itself reads and checks the parameters.
  ParameterSet given = metric.part.parameters;
  const std::vector<ParameterSpec>& specs =
      run_.registry.spec(PartKind::kMetric, metric.part.type).parameters;
  const bool judges_pictures = std::any_of(
      specs.begin(), specs.end(), [](const ParameterSpec& spec) { return spec.name == kCamera; });
  if (!judges_pictures || given.has(kCamera)) return given;
  std::vector<std::string> cameras;
  for (const scenario::NamedPart& sensor : config_.sensors) {
    const auto gives = run_.registry.spec(PartKind::kSensor, sensor.part.type).gives;
    if (gives == ProductKind::kPictures) cameras.push_back(sensor.name);
  }
  if (cameras.size() == 1) given.set(kCamera, cameras.front());
  return given;
}

void VehicleRuntime::add_actuators(Duration period) {
  actuator_values_.assign(vehicle_->description().actuators.size(), 0.0);
  schedule(Stage::kActuate, config_.name + ".actuators", period, {},
           [this](Time now) { actuate(now); });
}

void VehicleRuntime::add_payloads() {
  for (const scenario::NamedPart& payload : config_.payloads) {
    const std::string part = fmt::format("{}.payloads.{}", config_.name, payload.name);
    const double rate_Hz = payload.part.rate_Hz > 0.0 ? payload.part.rate_Hz : control_rate_Hz();
    auto payload_context = context<PayloadContext>(part, rate_Hz);
    payload_context.name = payload.name;
    payload_context.scene = &run_.physics.scene();
    payload_context.world = &run_.world;
    payload_context.vehicle_truth = vehicle_.get();
    payload_context.vehicle_description = &vehicle_->description();
    payload_context.map = &map();
    payloads_.emplace_back(payload.name, with_place(payload.part.where, config_.name, [&] {
                             return run_.registry.make_payload(
                                 payload.part.type, payload.part.parameters, payload_context);
                           }));
    add_stepped(Stage::kPayload, part, payload.part.type, rate_Hz, *payloads_.back().second);
  }
}

void VehicleRuntime::check_command(const SignalBase& value) const {
  if (value.name() != config_.name + "/actuators") return;
  if (std::string_view(value.type()) != NamedValues::kType) return;
  const NamedValues& wanted = static_cast<const Signal<NamedValues>&>(value).value();
  if (wanted.names.size() != wanted.values.size()) {
    throw ConfigError(fmt::format("a command for '{}' has {} values for {} names", value.name(),
                                  wanted.values.size(), wanted.names.size()));
  }
  for (const std::string& name : wanted.names) {
    static_cast<void>(vehicle_->description().actuator_index(
        name, fmt::format("a command for '{}'", value.name())));
  }
}

void VehicleRuntime::actuate(Time now) {
  watch_progress(now);
  if (crash_ && crash_->kind == EndKind::kStuck) {
    for (std::size_t i = 0; i < actuator_values_.size(); ++i) {
      const ActuatorSpec& spec = vehicle_->description().actuators[i];
      actuator_values_[i] = std::clamp(0.0, spec.min, spec.max);
    }
    vehicle_->actuate(actuator_values_);
    return;
  }
  if (!has_reported_finished_ && controller_ && finished()) {
    has_reported_finished_ = true;
    run_.emit(Event::Level::kInfo, config_.name + ".controller", "finished its path");
  }
  if (!actuators_.has_value() || !actuators_.is_newer_than(actuators_seen_)) return;
  const NamedValues& wanted = actuators_.value();
  const VehicleDescription& description = vehicle_->description();
  if (actuator_names_ != wanted.names) {
    actuator_names_ = wanted.names;
    actuator_index_.clear();
    for (const std::string& actuator : wanted.names) {
      actuator_index_.push_back(description.actuator_index(actuator, config_.name + ".controller"));
    }
  }
  if (wanted.values.size() != wanted.names.size()) {
    throw SimulationError(config_.name + ".controller", now,
                          fmt::format("wrote {} actuator values for {} names", wanted.values.size(),
                                      wanted.names.size()));
  }
  for (std::size_t i = 0; i < wanted.values.size(); ++i) {
    const ActuatorSpec& spec = description.actuators[actuator_index_[i]];
    actuator_values_[actuator_index_[i]] = std::clamp(wanted.values[i], spec.min, spec.max);
  }
  vehicle_->actuate(actuator_values_);
}

void VehicleRuntime::add_metrics() {
  for (const scenario::NamedPart& metric : run_.scenario.metrics) {
    const std::string part = fmt::format("{}.metrics.{}", config_.name, metric.name);
    // Metrics run at the controller's rate by default: paper B's samples are the poses at its
    // cycles.
    const double rate_Hz = metric.part.rate_Hz > 0.0 ? metric.part.rate_Hz : control_rate_Hz();
    auto metric_context = context<MetricContext>(part, rate_Hz);
    metric_context.vehicle_description = &vehicle_->description();
    metric_context.scene = &run_.physics.scene();
    metric_context.world = &run_.world;
    metric_context.vehicle_truth = vehicle_.get();
    for (const scenario::NamedPart& observer : config_.observers) {
      metric_context.observers.push_back(observer.name);
    }
    metrics_.push_back({metric.name, run_.registry.make_metric(
                                         metric.part.type, parameters_of(metric), metric_context)});

    add_stepped(Stage::kJudge, part, metric.part.type, rate_Hz, *metrics_.back().metric);
  }
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
  if (now.ns == 0) contacts_writer_.write(now, contacts_);
  // The log contains the map itself, so that viewers need not rebuild it from the world.
  if (map_edges_due_) {
    map_edges_due_ = false;
    map_edges_writer_.write(now, map_edges(*own_map_));
  }
}

std::map<std::string, double> VehicleRuntime::metric_results() const {
  std::map<std::string, double> all;
  for (const NamedMetric& metric : metrics_) {
    for (const auto& [name, value] : metric.metric->results()) all[name] = value;
  }
  for (const auto& [payload, part] : payloads_) {
    for (const auto& [name, value] : part->results()) all[payload + "_" + name] = value;
  }
  if (min_separation_m_) all["min_vehicle_distance_m"] = *min_separation_m_;
  if (!worked_) {
    for (auto& [name, value] : all) value = std::numeric_limits<double>::quiet_NaN();
  }
  return all;
}

}  // namespace vinerow
