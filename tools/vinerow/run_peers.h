#pragma once
/// Peers of `vinerow run`: its options, and what they start.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "engine/api/registry.h"
#include "engine/live/mavlink_peer.h"
#include "engine/live/ros2_bridge.h"
#include "engine/live/web_server.h"
#include "engine/run/command_log.h"
#include "engine/scenario/scenario.h"
#include "tools/terminal/progress_line.h"

namespace vinerow::tools {

/// Peers and speed of a run, or the log that stands for them.
struct PeerChoice {
  bool live = false;  ///< a server for browsers and Foxglove
  live::ServerOptions server;
  bool mavlink = false;
  live::MavlinkOptions ground_station;
  bool ros2 = false;
  live::Ros2Options ros2_node;
  std::optional<int> ros2_domain;  ///< absent: of the environment
  bool paused = false;
  std::optional<double> speed;            ///< simulated seconds per second; 0 = as fast as possible
  std::filesystem::path replay_commands;  ///< empty: none

  bool replays() const { return !replay_commands.empty(); }
  bool has_peers() const { return live || ros2 || mavlink; }
};

void add_peer_options(CLI::App& command, PeerChoice& choice);

/// Checks options against each other and the environment. @throws ConfigError
void complete_peer_options(PeerChoice& choice);

/// What accompanies a run.
class RunPeers {
 public:
  /// Starts servers and prints their addresses.
  /// @param out  folder of the run's files  @param line  outlives this object
  /// @throws ConfigError if the scenario needs a peer and there is none, or a server does not start
  RunPeers(const scenario::Scenario& scenario, const Registry& registry, const PeerChoice& choice,
           const std::filesystem::path& out, ProgressLine& line);
  ~RunPeers();

  /// May be null.
  std::shared_ptr<run::RunDriver> driver() const;
  /// Ends the servers.
  void leave();
  /// Prints whether a replay has the digest of its log. @returns false if it has another
  bool compare(const std::string& digest) const;

 private:
  void start(const scenario::Scenario& scenario, const Registry& registry, const PeerChoice& choice,
             const std::filesystem::path& out, ProgressLine& line);

  std::shared_ptr<run::CommandReplay> replay_;
  // Servers refer to the run, so they are destroyed first.
  std::shared_ptr<live::LiveRun> run_;
  std::unique_ptr<live::WebServer> server_;
  std::unique_ptr<live::Ros2Bridge> ros2_;
  std::unique_ptr<live::MavlinkPeer> mavlink_;
};

}  // namespace vinerow::tools
