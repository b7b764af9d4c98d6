#pragma once
/// Lock-step with an autopilot that runs: started here, or by someone else.

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "controllers/autopilot/ardupilot/lockstep.h"
#include "controllers/autopilot/ardupilot/lockstep_link.h"
#include "controllers/autopilot/link/child_process.h"
#include "controllers/autopilot/link/datagram_record.h"

namespace vinerow::controllers {

struct RunningLockstepOptions {
  mavlink::UdpAddress own;                     ///< where the autopilot sends its outputs
  std::optional<mavlink::UdpAddress> mavlink;  ///< where it sends MAVLink; absent: no MAVLink
  std::vector<std::string> command;  ///< program and arguments; empty: it is started elsewhere
  std::filesystem::path folder;      ///< it works there
  std::string parameters;            ///< text of a file there, for a program that is started
  std::filesystem::path record;      ///< pcap file; empty: none
  std::chrono::milliseconds start_limit{60'000};
  std::chrono::milliseconds answer_limit{10'000};
};

class RunningLockstep final : public Lockstep {
 public:
  /// Opens nothing yet: parts are also built to find mistakes before a run.
  RunningLockstep(RunningLockstepOptions options, std::string who)
      : options_(std::move(options)), who_(std::move(who)) {}

  /// @throws ConfigError if the port is taken or the program cannot be started
  Result<ServoPacket> begin(Time now) override;
  void send_state(Time now, std::string_view line) override;
  Result<ServoPacket> wait_for_outputs(Time now) override;
  std::span<const std::uint8_t> next_message(Time now) override;
  void send_message(Time now, std::span<const std::uint8_t> bytes) override;

  /// Name of the file with the parameters, in the program's folder.
  static constexpr const char* kParameterFile = "vinerow.parm";

 private:
  LockstepLink::GaveUp gave_up();
  /// The autopilot's ports are other ones in every run: 0 stands for them.
  void record(Time now, mavlink::UdpAddress from, mavlink::UdpAddress to,
              std::span<const std::uint8_t> bytes);
  mavlink::UdpAddress theirs() const { return {options_.own.host, 0}; }

  RunningLockstepOptions options_;
  std::string who_;
  std::optional<LockstepLink> link_;
  std::optional<mavlink::UdpSocket> mavlink_;
  std::optional<mavlink::UdpAddress> mavlink_peer_;
  std::optional<DatagramRecorder> recorder_;
  std::unique_ptr<ChildProcess> process_;  // ends before the socket closes
};

}  // namespace vinerow::controllers
