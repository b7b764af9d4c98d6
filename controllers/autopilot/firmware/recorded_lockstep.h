#pragma once
/// Lock-step with the recording of an autopilot: the same outputs without it.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "controllers/autopilot/firmware/lockstep.h"
#include "controllers/autopilot/link/datagram_record.h"

namespace vinerow::controllers {

class RecordedLockstep final : public Lockstep {
 public:
  /// @throws ConfigError if the file is no pcap file
  RecordedLockstep(const std::filesystem::path& file, const std::string& who);

  /// The first recorded outputs; empty if there are none.
  Bytes first_outputs() const { return next_ ? Bytes(next_->bytes) : Bytes(); }

  /// Fails at the end of the recording, and where the state differs from the recorded one: the
  /// outputs would answer another flight.
  Result<Bytes> begin(Time now, const BootState& boot_state) override;
  void send_state(Time now, const FirmwareState& state) override;
  Result<Bytes> wait_for_outputs(Time now) override;
  Bytes next_message(Time now) override;
  void send_message(Time now, Bytes bytes) override;

 private:
  Result<Bytes> next_outputs();
  void advance();
  /// Nobody gets them here.
  void skip_messages_to_firmware();

  std::string file_;
  DatagramReader reader_;
  Bytes state_;                            ///< the last one
  std::optional<RecordedDatagram> next_;   ///< in the recording
  std::optional<RecordedDatagram> taken_;  ///< what the last call returned
  mavlink::UdpAddress own_;                ///< where the outputs went
};

}  // namespace vinerow::controllers
