#include "engine/run/run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "engine/core/error.h"
#include "engine/core/profile.h"
#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"
#include "engine/io/files/plain_zeros.h"
#include "engine/playback/canopy_file.h"
#include "engine/playback/run_frames.h"
#include "engine/run/earlier_run.h"
#include "engine/run/junit.h"
#include "engine/run/log_observer.h"
#include "engine/run/run_profile.h"
#include "engine/run/summary.h"
#include "engine/sim/judge.h"
#include "engine/sim/session.h"
#include "engine/sim/simulation.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow::run {
namespace {

using Clock = std::chrono::steady_clock;

std::int64_t wall_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch())
      .count();
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Names of the vehicles whose planner has not planned yet.
std::vector<std::string> without_plan(const Simulation& simulation) {
  std::vector<std::string> names;
  for (const auto& vehicle : simulation.vehicles()) {
    if (vehicle->awaits_plan()) names.push_back(vehicle->name());
  }
  return names;
}

/// Steps to the end in slices of simulated time, to report progress. Slices change no result.
/// @param earlier  may be null; removed once nothing can be refused any more
/// @returns the seed of the next run if the driver wants to start again
std::optional<std::uint64_t> step_to_end(Session& session, const RunOptions& options,
                                         Clock::time_point start, EarlierRun* earlier) {
  const double duration_s = session.scenario().duration_s;
  constexpr Duration kSlice{250'000'000};
  double stated_s = -1.0;
  while (!session.over()) {
    RunDriver::Next next{session.now() + kSlice};
    if (options.driver) next = options.driver->next(session, next.until);
    if (next.restart_seed) return next.restart_seed;
    if (options.profile) options.profile->begin_slice(session.now());
    session.advance(next.until);
    if (options.profile) options.profile->end_slice(session.now());
    if (earlier && without_plan(session.simulation()).empty()) earlier->remove();
    if (options.interrupted && options.interrupted()) {
      const SimulationError error("run", session.now(), "interrupted by the user");
      session.simulation().emit(Event::Level::kError, error.culprit(), error.what());
      throw error;
    }
    const double wall_s = seconds_since(start);
    if (options.progress && (wall_s - stated_s > 0.2 || session.over())) {
      stated_s = wall_s;
      options.progress({session.now().s(), duration_s, wall_s});
    }
  }
  return std::nullopt;
}

/// Criteria that can be checked before the run. Those of jobs are excluded, because their numbers
/// may be known only after the run.
std::vector<scenario::Criterion> of_vehicles(const scenario::Scenario& scenario) {
  std::vector<scenario::Criterion> criteria;
  for (const scenario::Criterion& criterion : scenario.criteria) {
    const std::string owner = criterion.metric.substr(0, criterion.metric.find('.'));
    const bool is_job =
        std::any_of(scenario.phases.begin(), scenario.phases.end(),
                    [&](const auto& phase) { return phase.job && phase.name == owner; });
    if (!is_job) criteria.push_back(criterion);
  }
  return criteria;
}

/// Adds NaN for the numbers of jobs that did not succeed, so that their criteria are not met.
std::map<std::string, std::map<std::string, double>> with_missing_numbers(
    const scenario::Scenario& scenario,
    std::map<std::string, std::map<std::string, double>> metrics,
    const std::vector<PhaseReport>& phases) {
  for (const scenario::Criterion& criterion : scenario.criteria) {
    const std::size_t dot = criterion.metric.find('.');
    const std::string owner = criterion.metric.substr(0, dot);
    for (const PhaseReport& phase : phases) {
      if (phase.job.empty() || phase.name != owner || phase.state == PhaseState::kSucceeded) {
        continue;
      }
      metrics[owner].emplace(criterion.metric.substr(dot + 1),
                             std::numeric_limits<double>::quiet_NaN());
    }
  }
  return metrics;
}

std::vector<std::filesystem::path> write_canopy(const Simulation& simulation,
                                                const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code failed;
  for (const auto& vehicle : simulation.vehicles()) {
    for (const auto& [name, payload] : vehicle->payloads()) {
      const CanopyCoverage* coverage = payload->coverage();
      if (!coverage) continue;
      std::filesystem::create_directories(folder, failed);
      files.push_back(folder / fmt::format("{}_{}.json", vehicle->name(), name));
      write_whole_file(files.back(), playback::canopy_json(vehicle->name(), name, *coverage));
    }
  }
  return files;
}

/// Builds a run and makes all checks that are possible before its first step. @throws ConfigError
Session open_run(const scenario::Scenario& scenario, const Registry& registry,
                 SessionOptions options) {
  const ProfileSpan span("session", "set-up");
  // A non-owning pointer: the caller keeps the registry alive.
  Session session(scenario, std::shared_ptr<const Registry>(std::shared_ptr<void>(), &registry),
                  std::move(options));
  // Checked now, so that bad input is not found only after a long run.
  check_criteria(of_vehicles(scenario), session.metrics(), [&](const std::string& metric) {
    return find_declared_result(scenario, registry, metric);
  });
  return session;
}

/// Fills in the results of a run: numbers, verdicts, status.
void judge_run(const scenario::Scenario& scenario, const Session& session, RunResult& result) {
  const Simulation& simulation = session.simulation();
  result.simulated_s = session.now().nearest_s();
  result.digest = session.digest();
  result.finished = session.finished();
  result.metrics = session.metrics();
  result.planning = simulation.planning();
  result.phases = simulation.phases();
  result.criteria =
      judge(scenario.criteria, with_missing_numbers(scenario, result.metrics, result.phases));
  result.crashes = simulation.crashes();
  if (result.status != RunStatus::kAllMet) return;
  if (!result.crashes.empty()) result.status = RunStatus::kCriterionFailed;
  for (const Crash& crash : result.crashes) {
    result.error += (result.error.empty() ? "" : "; ") + crash.sentence();
  }
  for (const PhaseReport& phase : result.phases) {
    if (phase.state != PhaseState::kSucceeded) result.status = RunStatus::kCriterionFailed;
  }
  for (const CriterionResult& criterion : result.criteria) {
    if (!criterion.met) result.status = RunStatus::kCriterionFailed;
  }
}

void draw_pictures(const std::filesystem::path& log, const Registry& registry,
                   const RunOptions& options, RunResult& result) {
  const ProfileSpan span("pictures", "results");
  playback::PictureOptions drawing;
  drawing.progress = options.picture_progress;
  drawing.interrupted = options.interrupted;
  drawing.shelf = options.shelf;
  if (options.interrupted && options.interrupted()) {
    result.picture_note = "interrupted";
    return;
  }
  try {
    const playback::PictureReport pictures =
        playback::render_log(log, options.out / "frames", registry, drawing);
    result.pictures = pictures.files;
    result.picture_note = pictures.note;
    result.write_failure = pictures.write_failure;
  } catch (const ConfigError& error) {
    // The verdict is final; a failed drawing must not turn it into bad input.
    result.picture_note = error.what();
  }
}

/// Steps to the end and judges. @param log  may be null  @param earlier  as of step_to_end()
/// @returns the seed of the next run if the driver wants to start again; nothing is judged then
std::optional<std::uint64_t> step_and_judge(Session& session, const RunOptions& options,
                                            LogObserver* log, EarlierRun* earlier,
                                            RunResult& result) {
  Simulation& simulation = session.simulation();
  const scenario::Scenario& scenario = session.scenario();
  const auto break_off = [&](const SimulationError& error) {
    result.status = RunStatus::kBrokenOff;
    result.error = io::plain_zeros(error.what());
  };
  const Clock::time_point start = Clock::now();
  // A mission names its phases itself.
  if (scenario.phases.empty()) set_profile_phase("", "run");
  try {
    if (options.driver) options.driver->begin(session);
    const auto restart_seed = step_to_end(session, options, start, earlier);
    if (restart_seed) return restart_seed;
  } catch (const SimulationError& error) {
    break_off(error);
  }
  try {
    if (log && result.status != RunStatus::kBrokenOff) log->on_instant(simulation.now());
    const bool broke_off = result.status == RunStatus::kBrokenOff;
    if (log) log->finish(simulation, broke_off ? kRunBrokenOff : kRunOver);
  } catch (const SimulationError& error) {
    break_off(error);
    simulation.emit(Event::Level::kError, error.culprit(), error.what());
  }
  result.wall_s = seconds_since(start);
  set_profile_phase("", "results");
  const ProfileSpan span("verdict", "results");
  judge_run(scenario, session, result);
  if (options.driver) options.driver->end(session);
  return std::nullopt;
}

}  // namespace

std::vector<std::string> rehearse_run(const scenario::Scenario& scenario,
                                      const Registry& registry) {
  constexpr Duration kLongest{10'000'000'000};
  // A job may take minutes.
  SessionOptions options;
  options.is_rehearsal = true;
  Session session = open_run(scenario, registry, std::move(options));
  std::vector<std::string> notes = session.simulation().world().notes;
  std::set<std::string> without_firmware;
  for (const scenario::VehicleConfig& vehicle : scenario.vehicles) {
    if (!vehicle.autopilot) continue;
    without_firmware.insert(vehicle.name);
    notes.push_back(fmt::format(
        "{}.autopilot: plans are not checked, because no firmware is started", vehicle.name));
  }
  const auto unchecked = [&] {
    std::vector<std::string> names = without_plan(session.simulation());
    std::erase_if(names, [&](const auto& name) { return without_firmware.contains(name); });
    return names;
  };
  const auto note_events = [&] {
    for (const auto& [time, event] : session.take_events()) {
      if (event.level == Event::Level::kInfo) continue;
      notes.push_back(fmt::format("{}: {}", event.source, event.text));
    }
  };
  // The first instant in any case: parts may find faults in it.
  session.advance(session.now());
  note_events();
  if (!scenario.phases.empty()) return notes;
  while (!session.over() && session.now() <= Time{kLongest.ns} && !unchecked().empty()) {
    session.advance(session.now());
  }
  // Without its firmware, a vehicle soon does what it never does.
  if (without_firmware.empty()) note_events();
  for (const std::string& vehicle : unchecked()) {
    notes.push_back(
        fmt::format("{}.planner: not checked, because there is no estimate in the first {:g} s",
                    vehicle, session.now().s()));
  }
  return notes;
}

void check_runs_alone(const scenario::Scenario& scenario) {
  const scenario::LockstepConfig& lockstep = scenario.lockstep;
  if (lockstep.signal.empty()) return;
  throw ConfigError(
      fmt::format("{}: lockstep.topic = '{}' waits for the commands of a program outside, and this "
                  "run has none: remove 'lockstep', or use vinerow run with --ros2 or --live",
                  lockstep.where.text(), lockstep.signal));
}

RunResult run_scenario(const scenario::Scenario& scenario, const Registry& registry,
                       const RunOptions& options) {
  if (!options.driver) check_runs_alone(scenario);
  const bool writes = !options.out.empty();
  SessionOptions session_options;
  if (writes) session_options.products = options.out / "products";
  session_options.shelf = options.shelf;
  Session session = open_run(scenario, registry, std::move(session_options));
  const auto measure_cost = [&] {
    session.simulation().scheduler().set_clock(wall_ns, options.measure_cost);
  };
  measure_cost();

  RunResult result;
  if (!writes) {
    while (const auto seed = step_and_judge(session, options, nullptr, nullptr, result)) {
      session.reset(*seed);
      measure_cost();
    }
    return result;
  }
  std::optional<ProfileSpan> opening(std::in_place, "output files", "set-up");
  const io::ResultFolder folder(options.out);
  result.lock = std::make_shared<FolderLock>(options.out);
  // Space for the verdict, in case the disk fills up during the run.
  constexpr std::size_t kVerdictBytes = 1 << 20;
  DiskReserve reserve(options.out, kVerdictBytes);
  const std::filesystem::path log_file = options.out / "log.mcap";
  const bool with_log = options.log && scenario.record.enabled;
  std::unique_ptr<LogObserver> log;
  std::unique_ptr<EventFile> events;
  EarlierRun earlier(options.out);
  for (bool runs = true; runs;) {
    earlier.remove_new();
    write_whole_file(options.out / "scenario.resolved.yaml", session.scenario().resolved_yaml);
    Simulation& simulation = session.simulation();
    if (with_log) {
      log = std::make_unique<LogObserver>(simulation, log_file);
      simulation.add_observer(log.get());
    }
    events = std::make_unique<EventFile>(options.out / "events.jsonl");
    simulation.add_observer(events.get());
    opening.reset();
    std::optional<std::uint64_t> seed;
    try {
      seed = step_and_judge(session, options, log.get(), &earlier, result);
    } catch (const ConfigError&) {
      // Bad input that a part has found at the start, as a planner that has no way.
      log.reset();
      events.reset();
      earlier.put_back();
      throw;
    }
    earlier.remove();
    runs = seed.has_value();
    if (!runs) break;
    // The files are those of the last run; its observers must not outlive its signals.
    log.reset();
    session.reset(*seed);
    measure_cost();
  }

  reserve.give_back();
  Simulation& simulation = session.simulation();
  if (options.profile) {
    options.profile->set_two_cores_save_s(simulation.scheduler().two_cores_save_s());
  }
  const auto write_verdict = [&] {
    write_whole_file(options.out / "summary.json",
                     summary_json(result, simulation, options.profile));
    write_whole_file(options.out / "junit.xml", junit_xml(scenario.name, result));
  };
  const bool wants_pictures = options.pictures && !scenario.pictures.cameras.empty();
  if (wants_pictures && !with_log) {
    result.picture_note = "pictures are drawn from the log, which this run does not write";
  }
  const auto store = [&](const auto& write) {
    try {
      if (result.write_failure.empty()) write();
    } catch (const WriteError& error) {
      result.write_failure = error.what();
    }
  };
  store(write_verdict);
  store([&] {
    result.canopy = write_canopy(simulation, options.out / "canopy");
    if (!result.canopy.empty()) write_verdict();  // because it lists these files
  });
  store([&] { events->check(); });
  if (options.judged) options.judged(result);
  if (wants_pictures && with_log && result.write_failure.empty()) {
    draw_pictures(log_file, registry, options, result);
    store(write_verdict);  // because it lists the pictures
  }
  return result;
}

}  // namespace vinerow::run
