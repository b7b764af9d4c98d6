#pragma once
/// What steps together with the simulation by ArduPilot's interface: a running autopilot, or the
/// recording of one.

#include <cstdint>
#include <span>
#include <string_view>

#include "controllers/autopilot/ardupilot/servo_packet.h"
#include "engine/core/time.h"

namespace vinerow::controllers {

class Lockstep {
 public:
  virtual ~Lockstep() = default;
  /// The first packet. @returns a failure as a sentence without subject, "sent nothing for 10 s"
  virtual Result<ServoPacket> begin(Time now) = 0;
  /// Gives the state of an instant. @param line  stays valid until its outputs are there
  virtual void send_state(Time now, std::string_view line) = 0;
  /// Waits for the outputs for that state. @returns them, or a failure
  virtual Result<ServoPacket> wait_for_outputs(Time now) = 0;

  /// A datagram of MAVLink that came before the last packet; empty: no more. Valid until the next
  /// call. The autopilot's datagrams lie in the receiver's queue before its packet does, so what
  /// is read after the outputs does not depend on its pace.
  virtual std::span<const std::uint8_t> next_message(Time now) = 0;
  /// Sends MAVLink to the autopilot, which reads it when it gets the next state. Nothing is sent
  /// before its first message: its port is unknown.
  virtual void send_message(Time now, std::span<const std::uint8_t> bytes) = 0;
};

}  // namespace vinerow::controllers
