#include "engine/sim/mission.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "engine/api/map.h"
#include "engine/core/error.h"
#include "engine/core/profile.h"
#include "engine/core/suggest.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/plain_zeros.h"
#include "engine/scenario/scenario_phases.h"
#include "engine/sim/judge.h"

namespace vinerow {
namespace {

bool is_settled(PhaseState state) {
  return state != PhaseState::kWaiting && state != PhaseState::kRunning;
}

PhaseReport report_of(const scenario::PhaseConfig& config) {
  PhaseReport report;
  report.name = config.name;
  report.vehicles = config.vehicles;
  report.job = config.job ? config.job->type : "";
  report.after = config.after;
  return report;
}

/// Placeholder for a map that does not exist before the run, used to rehearse a vehicle's parts:
/// the true rows as row meshes, which every part that needs a map accepts.
std::shared_ptr<const RowMap> make_placeholder(const RunContext& run) {
  constexpr const char* kType = "row_mesh";
  const std::vector<std::string> known = run.registry.names(PartKind::kMap);
  const bool has_type = std::find(known.begin(), known.end(), kType) != known.end();
  if (!has_type || run.world.rows->rows.empty()) {
    return std::make_shared<RowMap>(run.world.rows);
  }
  MapContext context;
  context.part = "mission.stand_in_map";
  context.seed = run.scenario.seed;
  context.physics_step = run.scenario.physics_step;
  context.gravity_mps2 = run.scenario.gravity_mps2;
  context.shelf = run.shelf;
  context.world = &run.world;
  context.scene = &run.physics.scene();
  // Of the fewest heights: nothing measures it.
  ParameterSet coarse(run.registry.spec(PartKind::kMap, kType).parameters, kType);
  coarse.set("levels", std::int64_t{2});
  return run.registry.make_map(kType, coarse, context);
}

bool takes(const scenario::PhaseConfig& config, ProductKind kind) {
  return std::any_of(config.takes.begin(), config.takes.end(),
                     [&](const scenario::ProductSource& source) { return source.kind == kind; });
}

std::string seconds(Duration duration) {
  return fmt::format("{:.1f} s", duration.s());
}

}  // namespace

const char* to_string(PhaseState state) {
  switch (state) {
    case PhaseState::kWaiting:
      return "waiting";
    case PhaseState::kRunning:
      return "running";
    case PhaseState::kSucceeded:
      return "succeeded";
    case PhaseState::kFailed:
      return "failed";
    case PhaseState::kBlocked:
      return "blocked";
    case PhaseState::kStopped:
      return "stopped";
    case PhaseState::kNotStarted:
      return "not started";
  }
  return "?";
}

Mission::Mission(const RunContext& run,
                 const std::vector<std::unique_ptr<VehicleRuntime>>& vehicles,
                 std::filesystem::path products)
    : run_(run), vehicles_(vehicles), products_(std::move(products)) {
  for (const scenario::PhaseConfig& config : run_.scenario.phases) {
    Phase phase;
    phase.config = &config;
    phase.folder = products_ / config.name;
    for (const std::string& name : config.vehicles) {
      const auto vehicle = std::find_if(vehicles_.begin(), vehicles_.end(),
                                        [&](const auto& v) { return v->name() == name; });
      phase.vehicles.push_back(vehicle->get());
    }
    if (config.weather) {
      phase.weather = std::make_unique<WeatherWatch>(*config.weather, run_.world);
    }
    if (config.job) build_job(phase);
    phases_.push_back(std::move(phase));
    reports_.push_back(report_of(config));
    states_.names.push_back(config.name);
    states_.values.push_back(static_cast<double>(PhaseState::kWaiting));
  }
  rehearse();
  for (Phase& phase : phases_) {
    for (const scenario::VehicleConfig& vehicle : run_.scenario.vehicles) {
      for (const scenario::NamedPart& sensor : vehicle.sensors) {
        const std::string source = vehicle.name + "/" + sensor.name;
        const std::vector<std::string> sources =
            scenario::picture_sources(*phase.config, run_.scenario.vehicles, run_.registry);
        if (std::find(sources.begin(), sources.end(), source) == sources.end()) continue;
        phase.cameras.emplace_back(run_.bus, vehicle.name, sensor);
      }
    }
  }
  states_writer_ = run_.bus.advertise<NamedValues>("run/phases", "run");
}

void Mission::build_job(Phase& phase) {
  JobContext context;
  context.part = "phases." + phase.config->name;
  context.seed = run_.scenario.seed;
  context.physics_step = run_.scenario.physics_step;
  context.gravity_mps2 = run_.scenario.gravity_mps2;
  context.shelf = run_.shelf;
  context.world = &run_.world;
  context.scene = &run_.physics.scene();
  context.folder = phase.folder;
  context.plan = [this](const std::string& vehicle, std::shared_ptr<const RowMap> map) {
    return plan_for(vehicle, std::move(map));
  };
  const scenario::PartConfig& job = *phase.config->job;
  try {
    phase.job = run_.registry.make_job(job.type, job.parameters, context);
  } catch (const ConfigError& error) {
    throw ConfigError(fmt::format("{}: phases.{}.job ({}): {}", job.place_of(error.what()).text(),
                                  phase.config->name, job.type, error.what()));
  }
}

void Mission::check_criteria_of(
    const Phase& phase, std::map<std::string, std::map<std::string, double>> metrics) const {
  if (!phase.job) {
    check_criteria(phase.config->criteria, metrics, [&](const std::string& metric) {
      return find_declared_result(run_.scenario, run_.registry, metric);
    });
    return;
  }
  // A plug-in's job may declare no results; its numbers are then known only after it has run.
  const std::vector<ResultSpec>& results =
      run_.registry.spec(PartKind::kJob, phase.config->job->type).results;
  if (results.empty()) return;
  for (const ResultSpec& result : results) {
    metrics[""][result.name] = std::numeric_limits<double>::quiet_NaN();
  }
  check_criteria(phase.config->criteria, metrics,
                 [&](const std::string& metric) { return find_result(results, metric); });
}

void Mission::rehearse() {
  std::shared_ptr<const RowMap> placeholder;
  const auto placeholder_map = [&] {
    if (!placeholder) placeholder = make_placeholder(run_);
    return placeholder;
  };
  for (const Phase& phase : phases_) {
    PhaseHandover handover;
    if (takes(*phase.config, ProductKind::kMap)) handover.map = placeholder_map();
    if (takes(*phase.config, ProductKind::kPlan)) handover.plan = std::make_shared<PlannedPath>();
    std::map<std::string, std::map<std::string, double>> metrics;
    for (VehicleRuntime* vehicle : phase.vehicles) {
      vehicle->rehearse(handover);
      metrics[vehicle->name()] = vehicle->metric_results();
    }
    check_criteria_of(phase, metrics);
  }
}

Result<PlannedPath> Mission::plan_for(const std::string& name, std::shared_ptr<const RowMap> map) {
  std::vector<std::string> known;
  for (const auto& vehicle : vehicles_) {
    if (vehicle->name() == name) return vehicle->plan_ahead(std::move(map));
    known.push_back(vehicle->name());
  }
  return Failure{fmt::format("unknown vehicle '{}'{} (known: {})", name, did_you_mean(name, known),
                             join(known))};
}

std::size_t Mission::index_of(const std::string& name) const {
  const auto found = std::find_if(reports_.begin(), reports_.end(),
                                  [&](const PhaseReport& report) { return report.name == name; });
  return static_cast<std::size_t>(found - reports_.begin());
}

void Mission::advance(Time now) {
  // A phase that ends now may let others start at the same instant.
  while (step_all(now)) {
  }
  write_states(now);
}

bool Mission::step_all(Time now) {
  bool changed = false;
  for (std::size_t i = 0; i < phases_.size(); ++i) {
    const PhaseState before = reports_[i].state;
    if (before == PhaseState::kWaiting) wait(i, now);
    if (reports_[i].state == PhaseState::kRunning) watch(i, now);
    changed = changed || reports_[i].state != before;
  }
  return changed;
}

void Mission::wait(std::size_t i, Time now) {
  for (const std::string& name : phases_[i].config->after) {
    const PhaseReport& before = reports_[index_of(name)];
    if (before.state == PhaseState::kSucceeded) continue;
    if (!is_settled(before.state)) return;
    settle(i, now, PhaseState::kBlocked,
           fmt::format("waits for '{}', which {}", name,
                       before.state == PhaseState::kFailed    ? "failed"
                       : before.state == PhaseState::kBlocked ? "is blocked itself"
                                                              : "did not succeed"));
    return;
  }
  if (phases_[i].weather) {
    switch (phases_[i].weather->look(now)) {
      case WeatherWatch::Verdict::kWait:
        return;
      case WeatherWatch::Verdict::kGiveUp:
        fail(i, now,
             fmt::format("no window of weak wind occurred: the mean over {:g} s is {:.1f} m/s, the "
                         "limit {:g} m/s",
                         phases_[i].config->weather->over_s, phases_[i].weather->mean_mps(),
                         phases_[i].config->weather->max_wind_mps));
        return;
      case WeatherWatch::Verdict::kGo:
        break;
    }
  }
  begin(i, now);
}

void Mission::begin(std::size_t i, Time now) {
  PhaseReport& report = reports_[i];
  report.state = PhaseState::kRunning;
  report.begin = now;
  run_.emit(Event::Level::kInfo, "mission", fmt::format("phase '{}' begins", report.name));
  for (VehicleRuntime* vehicle : phases_[i].vehicles) {
    set_profile_phase(vehicle->name(), report.name);
  }
  note_phases();
  if (phases_[i].job) {
    const ProfileSpan span(report.name, "job");
    run_job(i, now);
  } else {
    start_vehicles(i, now);
  }
}

void Mission::note_phases() const {
  std::string names;
  for (const PhaseReport& report : reports_) {
    if (report.state != PhaseState::kRunning) continue;
    names += (names.empty() ? "" : " + ") + report.name;
  }
  set_profile_phase("", names.empty() ? "between phases" : names);
}

std::map<std::string, Product> Mission::inputs_of(std::size_t i) const {
  std::map<std::string, Product> inputs;
  for (const scenario::ProductSource& source : phases_[i].config->takes) {
    const std::size_t source_index = index_of(source.phase);
    if (reports_[source_index].product) inputs[source.key] = *reports_[source_index].product;
    for (const PictureCollector& camera : phases_[source_index].cameras) {
      const bool is_meant = source.item.empty() || source.item == camera.source();
      if (source.kind == ProductKind::kPictures && is_meant) inputs[source.key] = camera.product();
    }
  }
  return inputs;
}

void Mission::start_vehicles(std::size_t i, Time now) {
  PhaseHandover handover;
  for (const auto& [key, product] : inputs_of(i)) {
    if (product.kind == ProductKind::kMap) handover.map = product.map;
    if (product.kind == ProductKind::kPlan) handover.plan = product.plan;
  }
  for (VehicleRuntime* vehicle : phases_[i].vehicles) {
    if (vehicle->crash()) {
      fail(i, now, vehicle->crash()->sentence());
      return;
    }
    try {
      vehicle->begin(now, handover);
    } catch (const ConfigError& error) {
      // The configuration passed the rehearsal, so the error is in the products.
      fail(i, now, error.what());
      return;
    }
  }
}

void Mission::run_job(std::size_t i, Time now) {
  Phase& phase = phases_[i];
  PhaseReport& report = reports_[i];
  if (run_.is_rehearsal) {
    // A rehearsal builds what is there at the start. The job's product is not, so it never ends.
    phase.job_end = Time{std::numeric_limits<std::int64_t>::max()};
    return;
  }
  const Scheduler::Clock clock = run_.scheduler.clock();
  const std::int64_t start_ns = clock ? clock() : 0;
  std::error_code failed;
  std::filesystem::remove_all(phase.folder, failed);
  std::filesystem::create_directories(phase.folder, failed);
  if (failed) {
    throw ConfigError(
        fmt::format("folder '{}' cannot be created: {}", phase.folder.string(), failed.message()));
  }
  try {
    const Result<JobOutcome> outcome = phase.job->run(inputs_of(i));
    if (outcome) {
      report.product = outcome->product;
      report.numbers = outcome->numbers;
      report.notes = outcome->notes;
    } else {
      phase.job_failure = outcome.reason();
    }
  } catch (const SimulationError&) {
    throw;
  } catch (const ConfigError& error) {
    phase.job_failure = error.what();
  } catch (const WriteError& error) {
    throw SimulationError(fmt::format("phases.{} ({})", report.name, report.job), now,
                          error.what());
  } catch (const std::exception& error) {
    throw SimulationError(fmt::format("phases.{} ({})", report.name, report.job), now,
                          fmt::format("threw an exception: {}", error.what()));
  }
  if (clock) report.wall_s = static_cast<double>(clock() - start_ns) * 1e-9;
  phase.job_end = now + duration_from_s(phase.config->duration_s);
}

void Mission::watch(std::size_t i, Time now) {
  Phase& phase = phases_[i];
  for (PictureCollector& camera : phase.cameras) camera.look();
  if (phase.job) {
    if (now < *phase.job_end) return;
    if (phase.job_failure.empty()) {
      finish(i, now);
    } else {
      fail(i, now, phase.job_failure);
    }
    return;
  }
  bool all = true;
  std::vector<std::string> late;
  for (const VehicleRuntime* vehicle : phase.vehicles) {
    if (vehicle->crash()) {
      fail(i, now, vehicle->crash()->sentence());
      return;
    }
    if (!vehicle->plan_failure().empty()) {
      fail(i, now, vehicle->plan_failure());
      return;
    }
    if (vehicle->finished()) continue;
    all = false;
    late.push_back(vehicle->name());
  }
  if (all) {
    finish(i, now);
  } else if (phase.config->timeout_s > 0.0 &&
             now - *reports_[i].begin >= duration_from_s(phase.config->timeout_s)) {
    fail(i, now,
         fmt::format("{} had not finished within its timeout of {:g} s", join(late, " and "),
                     phase.config->timeout_s));
  }
}

void Mission::judge_phase(std::size_t i) {
  PhaseReport& report = reports_[i];
  for (const VehicleRuntime* vehicle : phases_[i].vehicles) {
    report.metrics[vehicle->name()] = vehicle->metric_results();
  }
  auto values = report.metrics;
  if (phases_[i].job) values[""] = report.numbers;
  report.criteria = judge(phases_[i].config->criteria, values);
}

void Mission::finish(std::size_t i, Time now) {
  PhaseReport& report = reports_[i];
  try {
    judge_phase(i);
  } catch (const ConfigError& error) {
    // This can happen only for numbers of a job, which cannot be checked before the run.
    fail(i, now, error.what());
    return;
  }
  std::vector<std::string> missed;
  for (const CriterionResult& criterion : report.criteria) {
    if (criterion.met) continue;
    missed.push_back(sentence_of(criterion));
  }
  if (!missed.empty()) {
    fail(i, now, "missed " + join(missed, " and "));
    return;
  }
  if (!phases_[i].cameras.empty()) report.product = phases_[i].cameras.front().product();
  settle(i, now, PhaseState::kSucceeded, "");
}

void Mission::fail(std::size_t i, Time now, const std::string& reason) {
  const bool ran = reports_[i].state == PhaseState::kRunning;
  if (ran && reports_[i].criteria.empty() && !phases_[i].job) judge_phase(i);
  settle(i, now, PhaseState::kFailed, reason);
  if (phases_[i].config->on_failure == scenario::OnFailure::kAbort) abort(i, now);
}

void Mission::settle(std::size_t i, Time now, PhaseState state, const std::string& reason) {
  PhaseReport& report = reports_[i];
  const bool ran = report.state == PhaseState::kRunning;
  report.state = state;
  report.reason = io::plain_zeros(reason);
  if (ran) {
    report.end = now;
    for (VehicleRuntime* vehicle : phases_[i].vehicles) {
      vehicle->end(vehicle->crash() || vehicle->finished());
      set_profile_phase(vehicle->name(), "after its phase");
    }
    note_phases();
  }
  const bool good = state == PhaseState::kSucceeded;
  std::string text = fmt::format("phase '{}' {}", report.name, to_string(state));
  if (ran) text += fmt::format(" after {}", seconds(now - *report.begin));
  if (!reason.empty()) text += ": " + reason;
  run_.emit(good ? Event::Level::kInfo : Event::Level::kError, "mission", text);
}

void Mission::abort(std::size_t failed, Time now) {
  const std::string reason =
      fmt::format("'{}' failed, which ends the mission", reports_[failed].name);
  for (std::size_t i = 0; i < phases_.size(); ++i) {
    if (reports_[i].state == PhaseState::kRunning) {
      if (!phases_[i].job) judge_phase(i);
      settle(i, now, PhaseState::kStopped, reason);
    }
  }
  // Phases that wait for a failed or stopped phase are blocked; the others are "not started".
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < phases_.size(); ++i) {
      if (reports_[i].state != PhaseState::kWaiting) continue;
      for (const std::string& name : phases_[i].config->after) {
        const PhaseState before = reports_[index_of(name)].state;
        if (!is_settled(before) || before == PhaseState::kSucceeded) continue;
        wait(i, now);
        changed = true;
        break;
      }
    }
  }
  for (std::size_t i = 0; i < phases_.size(); ++i) {
    if (reports_[i].state == PhaseState::kWaiting) {
      settle(i, now, PhaseState::kNotStarted, reason);
    }
  }
}

void Mission::close(Time now, const std::string& reason) {
  for (std::size_t i = 0; i < phases_.size(); ++i) {
    if (reports_[i].state == PhaseState::kRunning) {
      if (!phases_[i].job) judge_phase(i);
      settle(i, now, PhaseState::kFailed, reason);
    } else if (reports_[i].state == PhaseState::kWaiting) {
      settle(i, now, PhaseState::kNotStarted, reason);
    }
  }
  write_states(now);
}

void Mission::fail_phase_of(const std::string& vehicle, Time now, const std::string& reason) {
  for (std::size_t i = 0; i < phases_.size(); ++i) {
    if (reports_[i].state != PhaseState::kRunning) continue;
    const std::vector<std::string>& vehicles = phases_[i].config->vehicles;
    if (std::find(vehicles.begin(), vehicles.end(), vehicle) == vehicles.end()) continue;
    fail(i, now, reason);
    return;
  }
}

void Mission::write_states(Time now) {
  bool changed = now.ns == 0;
  for (std::size_t i = 0; i < reports_.size(); ++i) {
    const double state = static_cast<double>(reports_[i].state);
    changed = changed || states_.values[i] != state;
    states_.values[i] = state;
  }
  if (changed) states_writer_.write(now, states_);
}

bool Mission::over() const {
  return std::all_of(reports_.begin(), reports_.end(),
                     [](const PhaseReport& report) { return is_settled(report.state); });
}

bool Mission::succeeded() const {
  return std::all_of(reports_.begin(), reports_.end(), [](const PhaseReport& report) {
    return report.state == PhaseState::kSucceeded;
  });
}

}  // namespace vinerow
