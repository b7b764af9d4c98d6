#include "engine/sim/vehicle_assembly.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/api/map.h"
#include "engine/api/may_fail.h"
#include "engine/api/observer.h"
#include "engine/api/outside.h"
#include "engine/api/sees_ground.h"
#include "engine/core/error.h"
#include "engine/sim/spawn.h"
#include "engine/sim/truth_estimator.h"

namespace vinerow {
namespace {

/// Parameter of metrics that judge pictures: name of the sensor that takes them.
constexpr const char* kCamera = "camera";
/// Rate of parts without a rate of their own if the vehicle has no controller. Chosen: enough for
/// pictures; the recorder reduces it further.
constexpr double kDefaultControlRate_Hz = 20.0;

/// Runs `make` and prefixes the ConfigErrors of a vehicle's part with their place in the scenario.
template <class Make>
auto with_place(const scenario::PartConfig& config, const std::string& vehicle, Make&& make) {
  try {
    return make();
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    // Other messages already start with a place: that of a file or of the key.
    if (!text.starts_with(vehicle + ".") && !text.starts_with(vehicle + ":")) throw;
    throw ConfigError(fmt::format("{}: {}", config.place_of(text).text(), text));
  }
}

/// The part of a context that all kinds of parts have.
template <class Context>
Context make_part_context(const std::string& vehicle, const RunContext& run,
                          const std::string& part, double rate_Hz) {
  Context result;
  result.vehicle = vehicle;
  result.part = part;
  result.seed = run.scenario.seed;
  result.period = rate_Hz > 0.0 ? period_of_rate(rate_Hz) : Duration{};
  result.physics_step = run.scenario.physics_step;
  result.gravity_mps2 = run.scenario.gravity_mps2;
  result.shelf = run.shelf;
  return result;
}

}  // namespace

std::function<void(Time)> guarded(const SignalBus& bus, const std::string& part,
                                  const scenario::PartConfig& config,
                                  std::function<void(Time)> step) {
  const std::string culprit = fmt::format("{} ({})", part, config.type);
  // Without the parameters, which are large.
  const scenario::PartConfig given{config.type, config.rate_Hz, {}, config.where, config.given};
  std::vector<SignalBase*> written;
  for (const auto& signal : bus.signals()) {
    if (signal->writer() == part) written.push_back(signal.get());
  }
  return [part, given, culprit, written = std::move(written), step = std::move(step)](Time now) {
    try {
      step(now);
    } catch (const SimulationError&) {
      throw;
    } catch (const ConfigError& error) {
      // What a part finds at the start is bad input, as what it has found before.
      if (now == Time{0}) {
        throw ConfigError(
            fmt::format("{}: {}: {}", given.place_of(error.what()).text(), part, error.what()));
      }
      throw SimulationError(culprit, now, error.what());
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

std::unique_ptr<Vehicle> make_placed_vehicle(const scenario::VehicleConfig& config,
                                             const RunContext& run) {
  auto vehicle = with_place(config.vehicle, config.name, [&] {
    return run.registry.make_vehicle(
        config.vehicle.type, config.vehicle.parameters,
        make_part_context<VehicleContext>(config.name, run, config.name, 0.0));
  });
  const Pose X_WB = find_spawn_pose(config.spawn, run.world, run.physics.scene(), config.name,
                                    vehicle->description().height_above_ground_m,
                                    larger_ground_hint(run.scenario.world.parameters));
  with_place(config.vehicle, config.name, [&] { vehicle->spawn(run.physics, X_WB); });
  return vehicle;
}

template <class Context>
Context VehicleAssembly::context(const std::string& part, double rate_Hz) const {
  return make_part_context<Context>(config_.name, run_, part, rate_Hz);
}

void VehicleAssembly::build(const PhaseHandover& handover, std::optional<Time> begin,
                            RuntimeTicks ticks) {
  begin_ = begin;
  ticks_ = std::move(ticks);
  take_map(handover.map);
  if (parts_.own_map && !parts_.own_map->meshes.empty()) {
    parts_.map_edges =
        Ports(run_.bus, config_.name, config_.name + ".map").write<LineList>("map_edges");
    parts_.diagnostics.push_back(config_.name + "/map_edges");
  }
  add_sensors();
  if (config_.autopilot) add_autopilot();
  add_estimator();
  add_observers();
  const bool has_plan = handover.plan != nullptr;
  add_planner(has_plan);
  add_guidance();
  if (!config_.autopilot) add_controller(has_plan);
  add_payloads();
  add_metrics();
}

std::unique_ptr<Planner> VehicleAssembly::build_planner(std::shared_ptr<const RowMap> map) {
  take_map(std::move(map));
  return run_.registry.make_planner(config_.planner->type, config_.planner->parameters,
                                    planner_context());
}

void VehicleAssembly::take_map(std::shared_ptr<const RowMap> map) {
  if (!map && config_.map) {
    auto map_context = context<MapContext>(config_.name + ".map", 0.0);
    map_context.world = &run_.world;
    map_context.scene = &run_.physics.scene();
    map = run_.registry.make_map(config_.map->type, config_.map->parameters, map_context);
  }
  parts_.own_map = std::move(map);
  if (parts_.own_map && parts_.own_map->terrain) {
    parts_.map_ground.emplace(*parts_.own_map->terrain);
  }
}

double VehicleAssembly::control_rate_Hz() const {
  return config_.controller ? config_.controller->rate_Hz : kDefaultControlRate_Hz;
}

double VehicleAssembly::rate_of(const scenario::PartConfig& part) const {
  return part.rate_Hz > 0.0 ? part.rate_Hz : control_rate_Hz();
}

void VehicleAssembly::add_stepped(Stage stage, const std::string& part,
                                  const scenario::PartConfig& config, double rate_Hz,
                                  SteppedPart& stepped,
                                  std::map<std::string, std::string> written_as) {
  Ports ports(run_.bus, config_.name, part, std::move(written_as));
  stepped.connect(ports);
  schedule(stage, part, period_of_rate(rate_Hz), {},
           guarded(run_.bus, part, config, [&stepped](Time now) { stepped.step(now); }));
}

void VehicleAssembly::schedule(Stage stage, const std::string& part, Duration period,
                               Duration offset, std::function<void(Time)> run) {
  if (!begin_) return;
  parts_.tasks.push_back(run_.scheduler.add(stage, part, period, offset, std::move(run), *begin_));
}

void VehicleAssembly::add_sensors() {
  for (const scenario::NamedPart& sensor : config_.sensors) {
    const std::string part = fmt::format("{}.sensors.{}", config_.name, sensor.name);
    auto sensor_context = context<SensorContext>(part, sensor.part.rate_Hz);
    sensor_context.name = sensor.name;
    sensor_context.scene = &run_.physics.scene();
    sensor_context.light = [&physics = run_.physics]() -> const RayScene& {
      return physics.light_scene();
    };
    sensor_context.vehicles = run_.vehicles;
    sensor_context.world = &run_.world;
    sensor_context.vehicle_truth = &vehicle_;
    parts_.sensors.push_back(with_place(sensor.part, config_.name, [&] {
      return run_.registry.make_sensor(sensor.part.type, sensor.part.parameters, sensor_context);
    }));
    Sensor& built = *parts_.sensors.back();
    if (built.sampling().ns > 0) {
      schedule(Stage::kSense, part + ".sampling", built.sampling(), Duration{},
               guarded(run_.bus, part, sensor.part, [&built](Time now) { built.sample(now); }));
    }
    add_stepped(Stage::kSense, part, sensor.part, sensor.part.rate_Hz, built);
    // The error-free reading follows from the truth.
    parts_.diagnostics.push_back(fmt::format("{}/{}_truth", config_.name, sensor.name));
    if (const auto X_BS = built.mounting_X_BS()) {
      parts_.mountings.push_back({sensor.name, sensor.part.type, *X_BS});
    }
    if (built.delay().ns > 0) {
      schedule(Stage::kSense, part + ".delivery", sensor_context.period, built.delay(),
               guarded(run_.bus, part, sensor.part, [&built](Time now) { built.deliver(now); }));
    }
  }
}

void VehicleAssembly::add_estimator() {
  // An autopilot may write the estimate of its own firmware.
  const SignalBase* estimate = run_.bus.find(config_.name + "/estimate");
  if (estimate != nullptr && !estimate->writer().empty()) return;
  const std::string part = config_.name + ".estimator";
  const bool given = config_.estimator.has_value();
  const scenario::PartConfig config =
      given ? *config_.estimator
            : scenario::PartConfig{"truth", 0.0, {}, config_.vehicle.where, {}};
  const double rate = given ? rate_of(*config_.estimator) : control_rate_Hz();
  if (given) {
    parts_.estimator = with_place(*config_.estimator, config_.name, [&] {
      return run_.registry.make_estimator(config.type, config.parameters,
                                          estimator_context(part, rate));
    });
  } else {
    parts_.estimator = std::make_unique<TruthEstimator>();
  }
  add_stepped(Stage::kEstimate, part, config, rate, *parts_.estimator);
}

EstimatorContext VehicleAssembly::estimator_context(const std::string& part, double rate_Hz) const {
  auto result = context<EstimatorContext>(part, rate_Hz);
  result.vehicle_description = &vehicle_.description();
  result.map = &map();
  result.sensors = parts_.mountings;
  result.origin = run_.world.origin;
  return result;
}

void VehicleAssembly::add_observers() {
  for (const scenario::NamedPart& observer : config_.observers) {
    const std::string part = fmt::format("{}.observers.{}", config_.name, observer.name);
    const double rate = rate_of(observer.part);
    parts_.observers.push_back(with_place(observer.part, config_.name, [&] {
      return run_.registry.make_estimator(observer.part.type, observer.part.parameters,
                                          estimator_context(part, rate));
    }));
    add_stepped(Stage::kEstimate, part, observer.part, rate, *parts_.observers.back(),
                observer_signals(observer.name));
  }
}

PlannerContext VehicleAssembly::planner_context() const {
  auto result = context<PlannerContext>(config_.name + ".planner", control_rate_Hz());
  result.vehicle_description = &vehicle_.description();
  result.map = &map();
  result.scene = parts_.map_ground ? static_cast<const SceneQuery*>(&*parts_.map_ground)
                                   : &run_.physics.scene();
  result.origin = run_.world.origin;
  return result;
}

void VehicleAssembly::add_planner(bool has_plan) {
  if (!config_.planner && !has_plan) return;
  const std::string part = config_.name + ".planner";
  if (!has_plan) {
    parts_.planner = with_place(*config_.planner, config_.name, [&] {
      return run_.registry.make_planner(config_.planner->type, config_.planner->parameters,
                                        planner_context());
    });
  }
  Ports ports(run_.bus, config_.name, part);
  parts_.estimate = ports.read<Odometry>("estimate");
  parts_.plan = ports.write<PlannedPath>("plan");
  parts_.tree = ports.write<LineList>("plan_tree");
  parts_.diagnostics.push_back(config_.name + "/plan_tree");
  schedule(Stage::kPlan, part, period_of_rate(control_rate_Hz()), {}, std::move(ticks_.plan));
}

ControllerContext VehicleAssembly::controller_context(const std::string& part,
                                                      double rate_Hz) const {
  auto result = context<ControllerContext>(part, rate_Hz);
  result.vehicle_description = &vehicle_.description();
  result.map = &map();
  result.sensors = parts_.mountings;
  return result;
}

void VehicleAssembly::add_guidance() {
  if (!config_.guidance) return;
  if (!config_.controller) {
    throw ConfigError(fmt::format(
        "{}: {}.guidance ({}) needs a controller, but the vehicle has no controller: add one, or "
        "remove the guidance",
        config_.guidance->where.text(), config_.name, config_.guidance->type));
  }
  const std::string part = config_.name + ".guidance";
  const double rate = rate_of(*config_.guidance);
  parts_.guidance = with_place(*config_.guidance, config_.name, [&] {
    return run_.registry.make_guidance(config_.guidance->type, config_.guidance->parameters,
                                       controller_context(part, rate));
  });
  add_stepped(Stage::kGuide, part, *config_.guidance, rate, *parts_.guidance);
  note_if_it_may_fail(parts_.guidance.get());
  if (auto* looks = dynamic_cast<SeesGround*>(parts_.guidance.get())) {
    looks->see_ground(*planner_context().scene);
  }
  // The landing point follows from other signals.
  parts_.diagnostics.push_back(config_.name + "/landing");
}

void VehicleAssembly::schedule_actuators(double rate_Hz) {
  parts_.actuators = Ports(run_.bus, config_.name, config_.name).read<NamedValues>("actuators");
  schedule(Stage::kActuate, config_.name + ".actuators", period_of_rate(rate_Hz), {},
           std::move(ticks_.actuate));
}

void VehicleAssembly::add_autopilot() {
  const scenario::PartConfig& config = *config_.autopilot;
  const std::string part = config_.name + ".autopilot";
  auto autopilot_context = context<AutopilotContext>(part, config.rate_Hz);
  autopilot_context.vehicle_description = &vehicle_.description();
  autopilot_context.vehicle_truth = &vehicle_;
  autopilot_context.map = &map();
  autopilot_context.sensors = parts_.mountings;
  autopilot_context.origin = run_.world.origin;
  autopilot_context.folder = run_.products / part;
  std::unique_ptr<Autopilot> autopilot = with_place(config, config_.name, [&] {
    return run_.registry.make_autopilot(config.type, config.parameters, autopilot_context);
  });
  Autopilot& firmware = *autopilot;
  parts_.controller = std::move(autopilot);
  note_if_it_may_fail(parts_.controller.get());
  const std::optional<Time> begin = begin_;
  // A rehearsal has no firmware: steps without a begin are never due.
  if (run_.is_rehearsal) begin_.reset();
  add_stepped(Stage::kControl, part, config, config.rate_Hz, *parts_.controller);
  const std::string answer = part + ".answer";
  schedule(Stage::kActuate, answer, period_of_rate(config.rate_Hz), {},
           guarded(run_.bus, part, config, [&firmware](Time now) { firmware.finish_step(now); }));
  begin_ = begin;
  schedule_actuators(config.rate_Hz);
}

void VehicleAssembly::add_controller(bool has_plan) {
  if (config_.controller) {
    const std::string part = config_.name + ".controller";
    parts_.controller = with_place(*config_.controller, config_.name, [&] {
      return run_.registry.make_controller(config_.controller->type, config_.controller->parameters,
                                           controller_context(part, control_rate_Hz()));
    });
    note_if_it_may_fail(parts_.controller.get());
    add_stepped(Stage::kControl, part, *config_.controller, control_rate_Hz(), *parts_.controller);
    if (!parts_.planner && !has_plan) refuse_a_missing_plan();
    return schedule_actuators(control_rate_Hz());
  }
  parts_.actuators =
      Ports(run_.bus, config_.name, config_.name).read_optional<NamedValues>("actuators");
  if (run_.bus.find(config_.name + "/actuators")->writer() != kOutside) return;
  // Commands from outside act at their instant, hence at the rate of the physics step.
  schedule(Stage::kActuate, config_.name + ".actuators", run_.scenario.physics_step, {},
           std::move(ticks_.actuate));
}

void VehicleAssembly::refuse_a_missing_plan() const {
  const SignalBase* plan = run_.bus.find(config_.name + "/plan");
  if (plan == nullptr || !plan->writer().empty()) return;
  const auto refuse = [&](const scenario::PartConfig& part, const std::string& name) {
    if (plan->first_reader() != name) return;
    throw ConfigError(fmt::format("{}: {}: '{}' follows a plan, but the vehicle has no planner",
                                  part.where.text(), name, part.type));
  };
  if (config_.guidance) refuse(*config_.guidance, config_.name + ".guidance");
  refuse(*config_.controller, config_.name + ".controller");
}

void VehicleAssembly::note_if_it_may_fail(const SteppedPart* part) {
  if (const auto* may_fail = dynamic_cast<const MayFail*>(part)) {
    parts_.may_fail.push_back(may_fail);
  }
}

void VehicleAssembly::add_payloads() {
  for (const scenario::NamedPart& payload : config_.payloads) {
    const std::string part = fmt::format("{}.payloads.{}", config_.name, payload.name);
    const double rate = rate_of(payload.part);
    auto payload_context = context<PayloadContext>(part, rate);
    payload_context.name = payload.name;
    payload_context.scene = &run_.physics.scene();
    payload_context.world = &run_.world;
    payload_context.vehicle_truth = &vehicle_;
    payload_context.vehicle_description = &vehicle_.description();
    payload_context.map = &map();
    parts_.payloads.emplace_back(payload.name, with_place(payload.part, config_.name, [&] {
                                   return run_.registry.make_payload(
                                       payload.part.type, payload.part.parameters, payload_context);
                                 }));
    add_stepped(Stage::kPayload, part, payload.part, rate, *parts_.payloads.back().second);
  }
}

void VehicleAssembly::add_metrics() {
  for (const scenario::NamedPart& metric : run_.scenario.metrics) {
    const std::string part = fmt::format("{}.metrics.{}", config_.name, metric.name);
    // Metrics run at the controller's rate by default: paper B's samples are the poses at its
    // cycles.
    const double rate = rate_of(metric.part);
    auto metric_context = context<MetricContext>(part, rate);
    metric_context.vehicle_description = &vehicle_.description();
    metric_context.scene = &run_.physics.scene();
    metric_context.world = &run_.world;
    metric_context.vehicle_truth = &vehicle_;
    for (const scenario::NamedPart& observer : config_.observers) {
      metric_context.observers.push_back(observer.name);
    }
    parts_.metrics.push_back(with_place(metric.part, config_.name, [&] {
      return run_.registry.make_metric(metric.part.type, parameters_of(metric), metric_context);
    }));
    add_stepped(Stage::kJudge, part, metric.part, rate, *parts_.metrics.back());
  }
}

ParameterSet VehicleAssembly::parameters_of(const scenario::NamedPart& metric) const {
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

}  // namespace vinerow
