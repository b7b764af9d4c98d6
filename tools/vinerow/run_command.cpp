#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "engine/core/error.h"
#include "engine/core/profile.h"
#include "engine/core/whole_file.h"
#include "engine/run/run.h"
#include "engine/sim/judge.h"
#include "engine/sim/run_shelf.h"
#include "tools/report/run_files.h"
#include "tools/terminal/colour.h"
#include "tools/terminal/interrupt.h"
#include "tools/terminal/progress_line.h"
#include "tools/vinerow/profile_output.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {
namespace {

/// Thrown to leave work that Ctrl-C ends.
struct Interrupted {};

/// "257", "4.2", "0.019": so that a run slower than real time does not show 0.
std::string factor_text(double factor) {
  return factor < 9.95 ? fmt::format("{:.2g}", factor) : fmt::format("{:.0f}", factor);
}

void show_simulation(ProgressLine& line, const run::Progress& progress) {
  const double share = progress.duration_s > 0.0 ? progress.simulated_s / progress.duration_s : 1.0;
  const double factor = progress.wall_s > 0.0 ? progress.simulated_s / progress.wall_s : 0.0;
  // The last step may end a little after the duration.
  const double left_s =
      factor > 0.0 ? std::max(0.0, progress.duration_s - progress.simulated_s) / factor : 0.0;
  line.show("simulating", share,
            fmt::format("{:.1f} s, {} x real time, at most {:.0f} s left", progress.simulated_s,
                        factor_text(factor), left_s));
}

/// Prints "succeeded  survey        0.0 to 288.9 s", and the reason if the phase did not succeed.
void print_phase(const PhaseReport& phase) {
  const bool bad = phase.state == PhaseState::kFailed || phase.state == PhaseState::kBlocked;
  fmt::print("{}  {:16}",
             coloured(fmt::format("{:11}", to_string(phase.state)),
                      bad                                     ? Colour::kBad
                      : phase.state == PhaseState::kSucceeded ? Colour::kGood
                                                              : Colour::kPlain),
             phase.name);
  if (phase.begin && phase.end) {
    fmt::print(" {:8.1f} to {:8.1f} s", phase.begin->s(), phase.end->s());
  }
  fmt::print("{}{}\n", phase.reason.empty() ? "" : "  ", phase.reason);
  constexpr std::size_t kShown = 3;
  for (std::size_t i = 0; i < std::min(kShown, phase.notes.size()); ++i) {
    fmt::print("             {}\n", phase.notes[i]);
  }
  if (phase.notes.size() > kShown) {
    fmt::print("             and {} more in summary.json\n", phase.notes.size() - kShown);
  }
}

void print_verdict(const run::RunResult& result, const std::filesystem::path& out, bool with_log) {
  for (const PhaseReport& phase : result.phases) print_phase(phase);
  for (const CriterionResult& c : result.criteria) {
    fmt::print("{}  {}\n",
               c.met ? coloured("met   ", Colour::kGood) : coloured("FAILED", Colour::kBad),
               sentence_of(c));
  }
  fmt::print("simulated {:.3f} s in {:.2f} s ({} x real time), mission {}\n", result.simulated_s,
             result.wall_s, factor_text(result.real_time_factor()),
             result.finished ? "finished" : "not finished");
  fmt::print("digest   {}\n", result.digest);
  fmt::print("summary  {}\n", (out / "summary.json").string());
  if (with_log) fmt::print("log      {}\n", (out / "log.mcap").string());
  if (!result.error.empty()) {
    const bool broke_off = result.status == run::RunStatus::kBrokenOff;
    fmt::print(stderr, "vinerow: {}{}\n", broke_off ? "the run broke off: " : "", result.error);
  }
  // A reader at the other end of a pipe needs the verdict now, not after the pictures are drawn.
  std::fflush(stdout);
}

void print_pictures(const run::RunResult& result, const std::filesystem::path& out) {
  if (!result.pictures.empty()) {
    fmt::print("pictures {} in {}, the last is {}\n", result.pictures.size(),
               (out / "frames").string(), result.pictures.back().string());
  }
  if (!result.picture_note.empty()) {
    fmt::print("pictures {}: {}\n", result.pictures.empty() ? "none" : "not all",
               result.picture_note);
  }
}

/// A replay must not replace the log that it repeats.
std::filesystem::path default_folder(const scenario::Scenario& scenario, const RunChoice& choice) {
  const char* suffix = choice.peers.replays() ? "_replay" : "";
  return std::filesystem::path("runs") / (scenario.name + suffix);
}

void refuse_folder_of_replayed_log(const std::filesystem::path& out, const PeerChoice& peers) {
  std::error_code ignored;
  const std::filesystem::path folder = peers.replay_commands.parent_path();
  if (!peers.replays() || !std::filesystem::equivalent(out, folder.empty() ? "." : folder, ignored))
    return;
  throw ConfigError(fmt::format(
      "--out = '{}' contains the log of --replay-commands, which the run would replace: give "
      "another folder",
      out.string()));
}

}  // namespace

run::RunStatus run_and_report(const scenario::Scenario& scenario, const Registry& registry,
                              const RunChoice& choice) {
  run::RunOptions options;
  options.out = choice.out.empty() ? default_folder(scenario, choice) : choice.out;
  refuse_folder_of_replayed_log(options.out, choice.peers);
  options.log = !choice.no_log;
  options.pictures = !choice.no_pictures;
  // Pictures and report show the world of the run: built once.
  options.shelf = std::make_shared<RunShelf>();
  ProgressLine line(choice.quiet);
  RunPeers peers(scenario, registry, choice.peers, options.out, line);
  options.driver = peers.driver();
  options.profile = choice.profile;
  watch_for_interrupt();
  const bool with_log = options.log && scenario.record.enabled;
  options.progress = [&line](const run::Progress& progress) { show_simulation(line, progress); };
  options.picture_progress = [&line](int done, int total) {
    line.count("drawing pictures", done, total);
  };
  options.interrupted = is_interrupted;
  options.judged = [&](const run::RunResult& result) {
    line.end();
    print_verdict(result, options.out, with_log);
  };
  const run::RunResult result = run::run_scenario(scenario, registry, options);
  line.end();
  peers.leave();
  const bool is_repeated = peers.compare(result.digest);
  print_pictures(result, options.out);
  // Output that could not be written makes the exit status 3; the run's verdict stays.
  bool unwritten = !result.write_failure.empty();
  if (unwritten) fmt::print(stderr, "vinerow: {}\n", result.write_failure);
  const bool broke_off = result.status == run::RunStatus::kBrokenOff;
  const bool drawing_interrupted = is_interrupted() && !broke_off;
  try {
    if (drawing_interrupted) throw Interrupted();
    FurtherFiles further;
    further.out = options.out;
    further.coverage_and_maps = with_log && options.pictures;
    further.report = !choice.no_report;
    further.shelf = options.shelf;
    further.written = [&line](const char* kind, const std::vector<std::filesystem::path>& files) {
      line.end();
      for (const std::filesystem::path& file : files) fmt::print("{:8} {}\n", kind, file.string());
    };
    further.missing = [&](const std::string& sentence, bool not_stored) {
      unwritten |= not_stored;
      fmt::print(stderr, "vinerow: {}\n", sentence);
    };
    further.report_progress = [&](int done, int total) {
      // Ctrl-C during the simulation still writes the report.
      if (is_interrupted() && !broke_off) throw Interrupted();
      line.count("writing the report", done, total);
    };
    write_further_files(scenario, registry, result, further);
  } catch (const Interrupted&) {
    line.end();
    const std::string out = options.out.string();
    fmt::print(stderr,
               "vinerow: interrupted: verdict, log and the pictures so far are kept; 'vinerow "
               "render {}/log.mcap' draws the pictures, 'vinerow report {}' writes the report\n",
               out, out);
  }
  if (choice.profile) {
    try {
      fmt::print("{}", profile_table(*choice.profile));
      write_profile(*choice.profile, options.out);
      fmt::print("trace    {} (open it in Perfetto or speedscope)\n",
                 (options.out / "profile.json").string());
    } catch (const WriteError& error) {
      unwritten = true;
      fmt::print(stderr, "vinerow: no profile: {}\n", error.what());
    }
  }
  if (unwritten) return run::RunStatus::kBrokenOff;
  return is_repeated ? result.status : run::RunStatus::kCriterionFailed;
}

void add_run_command(CLI::App& app, int& exit_status) {
  struct Arguments {
    ScenarioArguments scenario;
    RunChoice choice;
    bool profile = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "run", "run a scenario without display; write log, summary, pictures and report");
  add_scenario_arguments(*command, arguments->scenario, "rover.controller.speed_mps=0.8");
  command->add_option("--out", arguments->choice.out,
                      "folder for the results (default: runs/<scenario name>)");
  command->add_flag("--no-log", arguments->choice.no_log, "write no log (and so no pictures)");
  command->add_flag("--no-pictures", arguments->choice.no_pictures, "draw no pictures");
  command->add_flag("--no-report", arguments->choice.no_report, "write no report.html");
  command->add_flag("--quiet", arguments->choice.quiet, "show no progress");
  command->add_flag("--profile", arguments->profile,
                    "measure computing time and heap allocations by part, stage and phase: a "
                    "table, and a trace for Perfetto or speedscope");
  add_peer_options(*command, arguments->choice.peers);
  command->callback([arguments, &exit_status] {
    complete_peer_options(arguments->choice.peers);
    std::optional<run::RunProfile> profile;
    if (arguments->profile) profile.emplace(make_profile());
    arguments->choice.profile = profile ? &*profile : nullptr;
    const ProfileRecording recording(arguments->choice.profile);
    Registry registry;
    const scenario::Scenario scenario = [&] {
      const ProfileSpan span("scenario file and plug-ins", "set-up");
      return load(arguments->scenario, registry);
    }();
    exit_status = static_cast<int>(run_and_report(scenario, registry, arguments->choice));
  });
}

}  // namespace vinerow::tools
