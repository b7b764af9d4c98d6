#pragma once
/// Lock-step with a firmware that runs, started here or by someone else: its program, its MAVLink
/// and the recording. How it exchanges states and outputs is its own.

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "controllers/autopilot/firmware/lockstep.h"
#include "controllers/autopilot/link/child_process.h"
#include "controllers/autopilot/link/datagram_record.h"
#include "controllers/autopilot/link/port_claim.h"

namespace vinerow::controllers {

struct RunningLockstepOptions {
  mavlink::UdpAddress own;                     ///< where the autopilot sends its outputs
  std::optional<mavlink::UdpAddress> mavlink;  ///< where it sends MAVLink; absent: no MAVLink
  std::vector<std::shared_ptr<const PortClaim>> claims;  ///< of both
  std::vector<std::string> command;      ///< program and arguments; empty: it is started elsewhere
  std::vector<std::string> environment;  ///< "NAME=value", added to ours
  std::filesystem::path folder;          ///< it works there
  /// Names and texts of files there, for a program that is started.
  std::vector<std::pair<std::string, std::string>> files;
  std::filesystem::path record;  ///< pcap file; empty: none
  std::chrono::milliseconds start_limit{60'000};
  std::chrono::milliseconds answer_limit{10'000};
};

class RunningLockstep : public Lockstep {
 public:
  /// Opens nothing yet: parts are also built to find mistakes before a run.
  RunningLockstep(RunningLockstepOptions options, std::string who)
      : options_(std::move(options)), who_(std::move(who)) {}

  Bytes next_message(Time now) final;
  void send_message(Time now, Bytes bytes) final;

 protected:
  const RunningLockstepOptions& options() const { return options_; }
  const std::string& who() const { return who_; }

  /// Opens the port of MAVLink and the recording, then starts the program, if there is one. The
  /// port of the outputs has to be open.
  /// @throws ConfigError if a port is taken or the program cannot be started
  void start();
  /// How the program ended; empty while it runs, or if it was started elsewhere.
  std::string ending() const { return process_ ? process_->ending() : std::string(); }
  /// True if MAVLink is not used or its first datagram has arrived.
  bool has_heard() const;
  void record_outputs(Time now, Bytes bytes) { record(now, theirs(), options_.own, bytes); }
  void record_state(Time now, Bytes bytes) { record(now, options_.own, theirs(), bytes); }

 private:
  /// The autopilot's ports are other ones in every run: 0 stands for them.
  mavlink::UdpAddress theirs() const { return {options_.own.host, 0}; }
  void record(Time now, mavlink::UdpAddress from, mavlink::UdpAddress to, Bytes bytes);

  RunningLockstepOptions options_;
  std::string who_;
  std::optional<mavlink::UdpSocket> mavlink_;
  std::optional<mavlink::UdpAddress> mavlink_peer_;
  std::optional<DatagramRecorder> recorder_;
  std::unique_ptr<ChildProcess> process_;  // ends before the sockets close
};

/// "10 s", for failures.
std::string seconds_text(std::chrono::milliseconds time);

}  // namespace vinerow::controllers
