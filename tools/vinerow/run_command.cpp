#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <memory>

#include "engine/core/error.h"
#include "engine/live/live_run.h"
#include "engine/live/web_server.h"
#include "engine/run/command_log.h"
#include "engine/run/run.h"
#include "engine/sim/judge.h"
#include "tools/live/live_page.h"
#include "tools/report/run_files.h"
#include "tools/terminal/colour.h"
#include "tools/terminal/interrupt.h"
#include "tools/terminal/progress_line.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {
namespace {

/// Thrown to leave work that Ctrl-C ends.
struct Interrupted {};

void show_simulation(ProgressLine& line, const run::Progress& progress) {
  const double share = progress.duration_s > 0.0 ? progress.simulated_s / progress.duration_s : 1.0;
  const double factor = progress.wall_s > 0.0 ? progress.simulated_s / progress.wall_s : 0.0;
  const double left_s = factor > 0.0 ? (progress.duration_s - progress.simulated_s) / factor : 0.0;
  line.show("simulating", share,
            fmt::format("{:.1f} s, {:.0f} x real time, at most {:.0f} s left", progress.simulated_s,
                        factor, left_s));
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
  fmt::print("simulated {:.3f} s in {:.2f} s ({:.0f} x real time), mission {}\n",
             result.simulated_s, result.wall_s, result.real_time_factor(),
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

/// Reads "max" or a number of simulated seconds per second; 0 = as fast as possible.
double read_speed(const std::string& text) {
  if (text == "max") return 0.0;
  double speed = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), speed);
  if (error != std::errc() || end != text.data() + text.size() || !(speed > 0.0 && speed <= 1e6)) {
    throw ConfigError(fmt::format(
        "--speed = '{}', must be max, or simulated seconds per second within (0, 1e6]", text));
  }
  return speed;
}

/// Checks that a run in lock-step has a peer to wait for.
void check_lockstep(const scenario::Scenario& scenario, const RunChoice& choice) {
  if (scenario.lockstep.signal.empty() || choice.live.serve || choice.live.ros2 ||
      !choice.replay_commands.empty()) {
    return;
  }
  throw ConfigError(
      fmt::format("{}: lockstep.topic = '{}' waits for the commands of a program outside: give "
                  "--ros2, --live, or "
                  "--replay-commands with the log of an earlier run",
                  scenario.lockstep.where.text(), scenario.lockstep.signal));
}

/// A run with peers. The server is destroyed first.
struct LiveParts {
  std::shared_ptr<live::LiveRun> run;
  std::unique_ptr<live::WebServer> server;
  std::unique_ptr<live::Ros2Bridge> ros2;
};

LiveParts start_live(const scenario::Scenario& scenario, const Registry& registry,
                     const LiveChoice& choice, ProgressLine& line) {
  live::ControlOptions control;
  const bool is_lockstep = !scenario.lockstep.signal.empty();
  if (is_lockstep) control.lockstep = scenario.lockstep;
  // People watch in real time; a peer in lock-step sets the pace itself.
  control.speed = choice.speed.value_or(is_lockstep ? 0.0 : 1.0);
  control.paused = choice.paused;
  LiveParts parts;
  parts.run = std::make_shared<live::LiveRun>(
      control, [&line](live::RunControl::Level, const std::string& sentence) {
        line.end();
        fmt::print(stderr, "vinerow: {}\n", sentence);
      });
  if (choice.ros2) {
    live::Ros2Options options = choice.ros2_options;
    options.holds_start = is_lockstep && !choice.serve;
    parts.ros2 = live::make_ros2_bridge(*parts.run, options);
    fmt::print("ros2     node /vinerow in domain {}{}\n", options.domain,
               options.network ? "" : ", on this machine");
    std::fflush(stdout);
  }
  if (!choice.serve) return parts;
  live::ServerOptions server;
  server.host = choice.host;
  server.port = static_cast<std::uint16_t>(choice.port);
  server.token = choice.token;
  const bool is_local =
      choice.host == "localhost" || choice.host == "::1" || choice.host.starts_with("127.");
  if (!is_local && server.token.empty()) server.token = live::make_token();
  parts.server = std::make_unique<live::WebServer>(*parts.run, server);
  fmt::print("live     {}\n", parts.server->url());
  std::fflush(stdout);
  parts.run->on_built([&server = *parts.server, &registry](const Simulation& simulation) {
    server.set_files(live_page_files(simulation, registry));
  });
  return parts;
}

/// Compares a replay with the run that it repeats. @returns whether the digests are equal
bool print_comparison(const run::CommandLog& log, const std::string& digest) {
  if (log.digest.empty()) {
    fmt::print("replay   of {} commands; the log has no digest, because its run was killed\n",
               log.commands.size());
    return true;
  }
  const bool equal = log.digest == digest;
  fmt::print(
      "replay   of {} commands: {}\n", log.commands.size(),
      equal ? coloured("the same digest as the log", Colour::kGood)
            : coloured(fmt::format("FAILED, the log's digest is {}", log.digest), Colour::kBad));
  return equal;
}

}  // namespace

run::RunStatus run_and_report(const scenario::Scenario& scenario, const Registry& registry,
                              const RunChoice& choice) {
  run::RunOptions options;
  options.out = choice.out.empty() ? std::filesystem::path("runs") / scenario.name : choice.out;
  options.log = !choice.no_log;
  options.pictures = !choice.no_pictures;
  ProgressLine line(choice.quiet);
  check_lockstep(scenario, choice);
  std::shared_ptr<run::CommandReplay> replay;
  LiveParts live;
  if (!choice.replay_commands.empty()) {
    replay = std::make_shared<run::CommandReplay>(run::read_command_log(choice.replay_commands));
    options.driver = replay;
  } else if (choice.live.is_wanted()) {
    live = start_live(scenario, registry, choice.live, line);
    options.driver = live.run;
  }
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
  live = {};
  const bool is_repeated = !replay || print_comparison(replay->log(), result.digest);
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
  if (unwritten) return run::RunStatus::kBrokenOff;
  return is_repeated ? result.status : run::RunStatus::kCriterionFailed;
}

void add_run_command(CLI::App& app, int& exit_status) {
  struct Arguments {
    ScenarioArguments scenario;
    RunChoice choice;
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
  command->add_option("--replay-commands", arguments->choice.replay_commands,
                      "repeat the commands from outside in this log (a run's folder or log.mcap) "
                      "and compare the digests");
  LiveChoice& live = arguments->choice.live;
  command->add_flag("--live", live.serve,
                    "serve the run to a browser and to Foxglove while it goes on, in real time");
  command->add_option(
      "--live-host", live.host,
      "address to listen on (default: 127.0.0.1, this machine alone; 0.0.0.0: all)");
  command->add_option("--live-port", live.port, "port to listen on (default: 8765; 0: any free)")
      ->check(CLI::Range(0, 65535));
  command->add_option("--live-token", live.token,
                      "secret that clients must give; default: none on this machine, a random one "
                      "for others");
  command->add_flag("--ros2", live.ros2,
                    "take part in ROS 2 as the node /vinerow while the run goes on, in real time");
  command
      ->add_option("--ros2-domain", live.ros2_options.domain,
                   "ROS 2 domain (default: $ROS_DOMAIN_ID, else 0)")
      ->envname("ROS_DOMAIN_ID")
      ->check(CLI::Range(0, 232));
  command
      ->add_option("--ros2-distribution", live.ros2_options.distribution,
                   "forms of messages that differ: humble, jazzy (default)")
      ->check(CLI::IsMember({"humble", "jazzy"}));
  command->add_flag("--ros2-network", live.ros2_options.network,
                    "be seen by ROS 2 nodes of other machines too");
  command->add_flag("--paused", live.paused, "start paused, until a client resumes the run");
  command->add_option_function<std::string>(
      "--speed", [&live](const std::string& text) { live.speed = read_speed(text); },
      "simulated seconds per second, or max (default: max; 1 with --live or --ros2, except in "
      "lock-step)");
  command->callback([arguments, &exit_status] {
    if (!arguments->choice.replay_commands.empty() && arguments->choice.live.is_wanted()) {
      throw ConfigError(
          "--replay-commands repeats a run without peers: leave out --live, --ros2, "
          "--paused and --speed");
    }
    if (!arguments->choice.replay_commands.empty()) {
      arguments->choice.replay_commands = log_of(arguments->choice.replay_commands);
    }
    if (arguments->choice.live.paused && !arguments->choice.live.serve &&
        !arguments->choice.live.ros2) {
      throw ConfigError("--paused waits for a client: give --live or --ros2 too");
    }
    Registry registry;
    const scenario::Scenario scenario = load(arguments->scenario, registry);
    exit_status = static_cast<int>(run_and_report(scenario, registry, arguments->choice));
  });
}

}  // namespace vinerow::tools
