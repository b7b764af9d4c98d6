#pragma once
/// Lock-step with the recording of an autopilot: the same outputs without it.

#include <filesystem>
#include <string>

#include "controllers/autopilot/ardupilot/lockstep.h"
#include "controllers/autopilot/link/datagram_record.h"

namespace vinerow::controllers {

class RecordedLockstep final : public Lockstep {
 public:
  /// @throws ConfigError if the file is no pcap file
  RecordedLockstep(const std::filesystem::path& file, const std::string& who);

  /// Fails at the end of the recording, and where the state differs from the recorded one: the
  /// outputs would answer another flight.
  Result<ServoPacket> begin(Time now) override;
  void send_state(Time now, std::string_view line) override;
  Result<ServoPacket> wait_for_outputs(Time now) override;
  std::span<const std::uint8_t> next_message(Time now) override;
  void send_message(Time now, std::span<const std::uint8_t> bytes) override;

 private:
  Result<ServoPacket> next_packet();
  void advance();
  /// Nobody gets them here.
  void skip_messages_to_firmware();

  std::string file_;
  DatagramReader reader_;
  std::string_view line_;                  ///< the last state
  std::optional<RecordedDatagram> next_;   ///< in the recording
  std::optional<RecordedDatagram> taken_;  ///< what the last call returned
  mavlink::UdpAddress own_;                ///< where the packets of the outputs went
};

}  // namespace vinerow::controllers
