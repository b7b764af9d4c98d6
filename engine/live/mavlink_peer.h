#pragma once
/// A live run as ground stations see it: every vehicle is a MAVLink system, over UDP.
///
/// Telemetry is what the vehicle itself believes (its estimate), as an autopilot's would be. What a
/// ground station sends becomes control of the run and commands from outside, which the log
/// contains; nothing else of it reaches the simulation.

#include <memory>
#include <string>

#include "engine/live/live_run.h"

namespace vinerow::live {

struct MavlinkOptions {
  std::string host = "127.0.0.1";  ///< of the ground station
  int port = 14550;                ///< where it listens
};

class MavlinkPeer {
 public:
  virtual ~MavlinkPeer() = default;
};

/// Takes part in the run; system 1 is the scenario's first vehicle. docs/guides/autopilots.md.
/// @param run  outlives the peer
/// @throws ConfigError if the address is no IPv4 address
std::unique_ptr<MavlinkPeer> make_mavlink_peer(LiveRun& run, const MavlinkOptions& options);

}  // namespace vinerow::live
