#include "engine/sim/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/api/messages/flight.h"
#include "engine/core/error.h"
#include "engine/record/recorder.h"
#include "engine/sim/canopy_file.h"
#include "engine/sim/judge.h"
#include "engine/sim/junit.h"
#include "engine/sim/pictures.h"
#include "engine/sim/session.h"
#include "engine/sim/simulation.h"
#include "engine/sim/summary.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow {
namespace {

using Clock = std::chrono::steady_clock;

std::int64_t wall_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch())
      .count();
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw ConfigError(fmt::format("'{}' cannot be written", file.string()));
}

/// Feeds the log: truth and diagnostics at their rate, sensors up to theirs, everything else as it
/// is written.
class LogObserver final : public RunObserver {
 public:
  LogObserver(const Simulation& simulation, const std::filesystem::path& file)
      : recorder_(file, options_of(simulation.scenario()), metadata_of(simulation.scenario())) {
    const io::RecordConfig& config = simulation.scenario().record;
    recorder_.add_attachment("scenario.resolved.yaml", "application/yaml",
                             simulation.scenario().resolved_yaml);
    for (const auto& signal : simulation.bus().signals()) {
      if (signal->writer().empty()) continue;
      recorder_.add_signal(*signal, shortest_period(*signal, config));
    }
  }

  void on_instant(Time now) override { recorder_.record(now); }
  /// Several events can fall into one instant; each is stored before the next overwrites it.
  void on_event(Time now, const Event&) override { recorder_.record(now); }

  void finish() { recorder_.finish(); }

 private:
  static record::RecorderOptions options_of(const io::Scenario& scenario) {
    record::RecorderOptions options;
    options.compression = scenario.record.compression;
    return options;
  }
  static std::map<std::string, std::string> metadata_of(const io::Scenario& scenario) {
    return {{"scenario", scenario.name},
            {"seed", std::to_string(scenario.seed)},
            {"vinerow", program_version()},
            {"latitude_longitude_note", "frame map is East-North-Up at the scenario's origin"}};
  }
  static Duration shortest_period(const SignalBase& signal, const io::RecordConfig& config) {
    const std::string& name = signal.name();
    const bool is_observed = std::string_view(signal.type()) == Odometry::kType &&
                             signal.writer().find(".observers.") != std::string::npos;
    const bool is_truth = name.ends_with("/truth") || name.ends_with("/estimate");
    if (is_truth || is_observed) return period_of_rate(config.truth_rate_Hz);
    // The widest message of all; half as often is enough to see slip come and go.
    if (name.ends_with("/wheels")) return period_of_rate(config.truth_rate_Hz) * 2;
    // A charge changes slowly, and its message is a large one.
    if (name.ends_with("/battery")) return period_of_rate(std::min(1.0, config.truth_rate_Hz));
    // The previews of one reference repeat each other.
    if (std::string_view(signal.type()) == ReferenceTrajectory::kType) {
      return period_of_rate(config.truth_rate_Hz) * 4;
    }
    const bool is_event = std::string_view(signal.type()) == Event::kType;
    if (is_event || name.ends_with("/plan") || name.ends_with("/contacts")) return {};
    return period_of_rate(config.sensor_rate_limit_Hz);
  }

  record::Recorder recorder_;
};

class EventFile final : public RunObserver {
 public:
  explicit EventFile(const std::filesystem::path& file) : out_(file) {}
  void on_event(Time now, const Event& event) override {
    const char* level = event.level == Event::Level::kInfo      ? "info"
                        : event.level == Event::Level::kWarning ? "warning"
                                                                : "error";
    out_ << nlohmann::ordered_json{{"t_s", now.s()},
                                   {"level", level},
                                   {"source", event.source},
                                   {"text", event.text}}
                .dump()
         << std::endl;  // flushed line by line: a killed run's events stay readable
  }

 private:
  std::ofstream out_;
};

/// Steps to the end in slices of simulated time, so that progress can be told. Slices change no
/// result.
void step_to_end(Session& session, const RunOptions& options, Clock::time_point start) {
  const double duration_s = session.scenario().duration_s;
  constexpr Duration kSlice{250'000'000};
  double told_s = -1.0;
  while (!session.over()) {
    session.advance(session.now() + kSlice);
    if (options.interrupted && options.interrupted()) {
      throw SimulationError("run", session.now(), "interrupted by the user");
    }
    const double wall_s = seconds_since(start);
    if (options.progress && (wall_s - told_s > 0.2 || session.over())) {
      told_s = wall_s;
      options.progress({session.now().s(), duration_s, wall_s});
    }
  }
}

/// The criteria that can be judged before the run: a job's numbers are known after it.
std::vector<io::Criterion> of_vehicles(const io::Scenario& scenario) {
  std::vector<io::Criterion> criteria;
  for (const io::Criterion& criterion : scenario.criteria) {
    const std::string owner = criterion.metric.substr(0, criterion.metric.find('.'));
    const bool is_job =
        std::any_of(scenario.phases.begin(), scenario.phases.end(),
                    [&](const auto& phase) { return phase.job && phase.name == owner; });
    if (!is_job) criteria.push_back(criterion);
  }
  return criteria;
}

/// Numbers that a job did not come to give are not measured, so that its criteria are not met.
std::map<std::string, std::map<std::string, double>> with_missing_numbers(
    const io::Scenario& scenario, std::map<std::string, std::map<std::string, double>> metrics,
    const std::vector<PhaseReport>& phases) {
  for (const io::Criterion& criterion : scenario.criteria) {
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

/// What an earlier run left in the same folder would be taken for this one's. Products stay until a
/// job makes its own anew: another run may still want them.
void clear_earlier_run(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::vector<std::filesystem::path> earlier;
  for (const char* name : {"log.mcap", "report.html", "replay.html", "frames", "canopy"}) {
    earlier.push_back(folder / name);
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::filesystem::path& file = entry.path();
    const std::string stem = file.stem().string();
    const bool of_coverage = stem == "coverage" || stem.starts_with("coverage_");
    if (of_coverage && (file.extension() == ".png" || file.extension() == ".json")) {
      earlier.push_back(file);
    }
  }
  for (const std::filesystem::path& path : earlier) std::filesystem::remove_all(path, ignored);
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
      write_text(files.back(), canopy_json(vehicle->name(), name, *coverage));
    }
  }
  return files;
}

const char* end_by(const Crash& crash) {
  return crash.gave_up ? "ended: a vehicle gave up" : "ended after a crash";
}

}  // namespace

RunResult run_scenario(const io::Scenario& scenario, const Registry& registry,
                       const RunOptions& options) {
  SessionOptions session_options;
  session_options.products = options.out / "products";
  // The caller keeps the registry.
  Session session(scenario, std::shared_ptr<const Registry>(std::shared_ptr<void>(), &registry),
                  std::move(session_options));
  Simulation& simulation = session.simulation();
  simulation.scheduler().set_clock(wall_ns, options.measure_cost);
  // Unknown metric names are bad input and must not wait for the end of a long run.
  static_cast<void>(judge(of_vehicles(scenario), simulation.metrics()));

  std::error_code failed;
  std::filesystem::create_directories(options.out, failed);
  if (failed)
    throw ConfigError(
        fmt::format("folder '{}' cannot be made: {}", options.out.string(), failed.message()));
  clear_earlier_run(options.out);
  write_text(options.out / "scenario.resolved.yaml", scenario.resolved_yaml);
  const std::filesystem::path log_file = options.out / "log.mcap";
  const bool with_log = options.log && scenario.record.enabled;
  std::unique_ptr<LogObserver> log;
  if (with_log) {
    log = std::make_unique<LogObserver>(simulation, log_file);
    simulation.add_observer(log.get());
  }
  EventFile events(options.out / "events.jsonl");
  simulation.add_observer(&events);

  RunResult result;
  const Clock::time_point start = Clock::now();
  try {
    simulation.emit(Event::Level::kInfo, "run", fmt::format("started '{}'", scenario.name));
    step_to_end(session, options, start);
    simulation.emit(Event::Level::kInfo, "run",
                    simulation.finished()           ? "mission finished"
                    : !scenario.phases.empty()      ? "mission ended"
                    : !simulation.crashes().empty() ? end_by(simulation.crashes().front())
                                                    : "duration is over");
    if (log) log->on_instant(simulation.now());
  } catch (const SimulationError& error) {
    result.status = RunStatus::kBrokenOff;
    result.error = error.what();
    simulation.emit(Event::Level::kError, error.culprit(), error.what());
  }
  if (log) log->finish();

  result.wall_s = seconds_since(start);
  result.simulated_s = session.now().s();
  result.digest = session.digest();
  result.finished = session.finished();
  result.metrics = session.metrics();
  result.phases = simulation.phases();
  result.criteria =
      judge(scenario.criteria, with_missing_numbers(scenario, result.metrics, result.phases));
  result.crashes = simulation.crashes();
  if (result.status == RunStatus::kAllMet) {
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
  if (options.pictures && !scenario.pictures.cameras.empty()) {
    if (with_log) {
      const PictureReport pictures = render_log(log_file, options.out / "frames", registry, {});
      result.pictures = pictures.files;
      result.picture_note = pictures.note;
    } else {
      result.picture_note = "pictures are drawn from the log, which this run does not write";
    }
  }
  result.canopy = write_canopy(simulation, options.out / "canopy");
  write_text(options.out / "summary.json", summary_json(result, simulation));
  write_text(options.out / "junit.xml", junit_xml(scenario.name, result));
  return result;
}

}  // namespace vinerow
