#include "tools/vinerow/run_peers.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "engine/core/error.h"
#include "engine/live/live_run.h"
#include "tools/live/live_page.h"
#include "tools/terminal/colour.h"
#include "tools/vinerow/subcommands.h"

namespace vinerow::tools {
namespace {

constexpr int kLastDomain = 232;  // the last whose ports exist

const std::map<std::string, live::Localisation> kLocalisations = {
    {"truth", live::Localisation::kTruth},
    {"estimate", live::Localisation::kEstimate},
    {"none", live::Localisation::kNone}};

/// Reads a whole text as a number.
template <class T>
std::optional<T> number_in(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Reads "max" or a number of simulated seconds per second; 0 = as fast as possible.
double read_speed(const std::string& text) {
  if (text == "max") return 0.0;
  const std::optional<double> speed = number_in<double>(text);
  if (speed && *speed > 0.0 && *speed <= 1e6) return *speed;
  throw ConfigError(fmt::format(
      "--speed = '{}', must be max, or simulated seconds per second within (0, 1e6]", text));
}

/// The domain of the environment, as ROS 2 programs take it.
int domain_of_environment() {
  const char* text = std::getenv("ROS_DOMAIN_ID");
  if (text == nullptr || *text == '\0') return 0;
  const std::optional<int> domain = number_in<int>(text);
  if (domain && *domain >= 0 && *domain <= kLastDomain) return *domain;
  throw ConfigError(
      fmt::format("ROS_DOMAIN_ID = '{}', must be a whole number from 0 to {}", text, kLastDomain));
}

void check_lockstep(const scenario::Scenario& scenario, const PeerChoice& choice) {
  if (scenario.lockstep.signal.empty() || choice.has_peers() || choice.replays()) return;
  throw ConfigError(
      fmt::format("{}: lockstep.topic = '{}' waits for the commands of a program outside: give "
                  "--ros2, --live, or --replay-commands with the log of an earlier run",
                  scenario.lockstep.where.text(), scenario.lockstep.signal));
}

}  // namespace

void add_peer_options(CLI::App& command, PeerChoice& choice) {
  command.add_option("--replay-commands", choice.replay_commands,
                     "repeat the commands from outside in this log (a run's folder or log.mcap) "
                     "and compare the digests");
  CLI::Option* live =
      command.add_flag("--live", choice.live,
                       "serve the run to a browser and to Foxglove while it goes on, in real time");
  command
      .add_option("--live-host", choice.server.host,
                  "address to listen on (default: 127.0.0.1, this machine alone; 0.0.0.0: all)")
      ->needs(live);
  command
      .add_option("--live-port", choice.server.port,
                  "port to listen on (default: 8765; 0: any free)")
      ->check(CLI::Range(0, 65535))
      ->needs(live);
  command
      .add_option("--live-token", choice.server.token,
                  "secret that clients must give; default: none on this machine, a random one for "
                  "others")
      ->needs(live);
  CLI::Option* ros2 =
      command.add_flag("--ros2", choice.ros2,
                       "take part in ROS 2 as the node /vinerow while the run goes on, in real "
                       "time");
  command
      .add_option("--ros2-domain", choice.ros2_domain,
                  "ROS 2 domain (default: $ROS_DOMAIN_ID, else 0)")
      ->check(CLI::Range(0, kLastDomain))
      ->needs(ros2);
  command
      .add_option("--ros2-distribution", choice.ros2_node.distribution,
                  "forms of messages that differ: humble, jazzy (default)")
      ->check(CLI::IsMember({"humble", "jazzy"}))
      ->needs(ros2);
  command
      .add_flag("--ros2-network", choice.ros2_node.network,
                "be seen by ROS 2 nodes of other machines too")
      ->needs(ros2);
  command
      .add_option_function<std::string>(
          "--ros2-localisation",
          [&choice](const std::string& name) {
            choice.ros2_node.localisation = kLocalisations.at(name);
          },
          "what gives the transform from map to <vehicle>/odom: truth (default), estimate, or none "
          "for a node of yours")
      ->check(CLI::IsMember(kLocalisations))
      ->needs(ros2);
  CLI::Option* mavlink =
      command.add_flag("--mavlink", choice.mavlink,
                       "show the vehicles to a ground station (QGroundControl) while the run goes "
                       "on, in real time");
  command
      .add_option("--mavlink-host", choice.ground_station.host,
                  "IPv4 address of the ground station (default: 127.0.0.1)")
      ->needs(mavlink);
  command
      .add_option("--mavlink-port", choice.ground_station.port,
                  "UDP port where it listens (default: 14550)")
      ->check(CLI::Range(1, 65535))
      ->needs(mavlink);
  command.add_flag("--paused", choice.paused, "start paused, until a client resumes the run");
  command.add_option_function<std::string>(
      "--speed", [&choice](const std::string& text) { choice.speed = read_speed(text); },
      "simulated seconds per second, or max (default: max; 1 with --live, --ros2 or --mavlink, "
      "except in lock-step)");
}

void complete_peer_options(PeerChoice& choice) {
  if (choice.replays()) {
    if (choice.has_peers() || choice.paused || choice.speed) {
      throw ConfigError(
          "--replay-commands repeats a run without peers: leave out --live, --ros2, --mavlink, "
          "--paused and --speed");
    }
    choice.replay_commands = log_of(choice.replay_commands);
  }
  if (choice.paused && !choice.has_peers()) {
    throw ConfigError("--paused waits for a client: give --live, --ros2 or --mavlink too");
  }
  // Read only where it counts: a strange value must not stop other runs.
  if (!choice.ros2) return;
  choice.ros2_node.domain = choice.ros2_domain ? *choice.ros2_domain : domain_of_environment();
}

RunPeers::RunPeers(const scenario::Scenario& scenario, const Registry& registry,
                   const PeerChoice& choice, const std::filesystem::path& out, ProgressLine& line) {
  check_lockstep(scenario, choice);
  if (choice.replays()) {
    replay_ = std::make_shared<run::CommandReplay>(run::read_command_log(choice.replay_commands));
  } else if (choice.has_peers() || choice.speed) {
    start(scenario, registry, choice, out, line);
  }
}

RunPeers::~RunPeers() = default;

void RunPeers::start(const scenario::Scenario& scenario, const Registry& registry,
                     const PeerChoice& choice, const std::filesystem::path& out,
                     ProgressLine& line) {
  const bool is_lockstep = !scenario.lockstep.signal.empty();
  live::ControlOptions control;
  if (is_lockstep) control.lockstep = scenario.lockstep;
  // People watch in real time; a peer in lock-step sets the pace itself.
  control.speed = choice.speed.value_or(is_lockstep ? 0.0 : 1.0);
  control.paused = choice.paused;
  run_ = std::make_shared<live::LiveRun>(
      control, [&line](live::RunControl::Level, const std::string& sentence) {
        line.end();
        fmt::print(stderr, "vinerow: {}\n", sentence);
      });
  if (choice.ros2) {
    live::Ros2Options options = choice.ros2_node;
    options.is_lockstep = is_lockstep;
    options.out = out;
    // With a browser, a person decides when the run begins.
    options.holds_start = is_lockstep && !choice.live;
    ros2_ = live::make_ros2_bridge(*run_, options);
    fmt::print("ros2     node /vinerow in domain {}{}\n", options.domain,
               options.network ? "" : ", on this machine");
  }
  if (choice.mavlink) {
    mavlink_ = live::make_mavlink_peer(*run_, choice.ground_station);
    fmt::print("mavlink  udp://{}:{}\n", choice.ground_station.host, choice.ground_station.port);
  }
  if (choice.live) {
    server_ = std::make_unique<live::WebServer>(*run_, choice.server);
    fmt::print("live     {}\n", server_->url());
    run_->on_built([this, &registry](const Simulation& simulation) {
      server_->set_page(live_page(simulation, registry));
    });
  }
  std::fflush(stdout);
}

std::shared_ptr<run::RunDriver> RunPeers::driver() const {
  if (replay_) return replay_;
  return run_;
}

void RunPeers::leave() {
  mavlink_ = nullptr;
  ros2_ = nullptr;
  server_ = nullptr;
}

bool RunPeers::compare(const std::string& digest) const {
  if (!replay_) return true;
  const run::CommandLog& log = replay_->log();
  if (log.digest.empty()) {
    fmt::print("replay   of {} commands; the log has no digest, because its run was killed\n",
               log.commands.size());
    return true;
  }
  const bool is_equal = log.digest == digest;
  fmt::print(
      "replay   of {} commands: {}\n", log.commands.size(),
      is_equal ? coloured("the same digest as the log", Colour::kGood)
               : coloured(fmt::format("FAILED, the log's digest is {}", log.digest), Colour::kBad));
  return is_equal;
}

}  // namespace vinerow::tools
